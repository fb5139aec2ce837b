#include "engine/accuracy/report_files.h"

#include <array>

#include "engine/accuracy/json_text.h"
#include "engine/accuracy/report_json.h"
#include "engine/accuracy/report_page.h"
#include "engine/accuracy/report_text.h"
#include "engine/error.h"
#include "engine/image/image_file.h"

namespace edgesplat::accuracy {

void check_report_folder(const std::filesystem::path& folder) {
    std::error_code error;
    if (std::filesystem::exists(folder, error)) {
        if (!std::filesystem::is_directory(folder, error)) fail("{} is not a folder", folder.string());
        check_output_path(folder / "report.json");
        return;
    }
    const std::filesystem::path parent = std::filesystem::absolute(folder).parent_path();
    if (!std::filesystem::is_directory(parent, error)) fail("the folder {} does not exist", parent.string());
    check_output_path(parent / "report.json");
}

void write_report(const Measured& measured) {
    const std::filesystem::path& folder = measured.report.options.folder;
    const std::array<FileContent, 3> files{{{folder / "report.json", json_text(report_json(measured.report), 2) + "\n"},
                                            {folder / "steps.csv", steps_csv(measured.report)},
                                            {folder / "index.html", report_page(measured)}}};
    write_files(files);
}

}  // namespace edgesplat::accuracy
