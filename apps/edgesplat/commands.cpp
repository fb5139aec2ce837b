#include "apps/edgesplat/commands.h"

#include <memory>

#include "apps/device_options.h"
#include "apps/edgesplat/accuracy_command.h"
#include "apps/edgesplat/bench_command.h"
#include "apps/edgesplat/check_command.h"
#include "apps/edgesplat/compare_command.h"
#include "apps/edgesplat/effects_command.h"
#include "apps/edgesplat/footprints_command.h"
#include "apps/edgesplat/help_formatter.h"
#include "apps/edgesplat/info_command.h"
#include "apps/edgesplat/measure_command.h"
#include "apps/edgesplat/movie_command.h"
#include "apps/edgesplat/pack_command.h"
#include "apps/edgesplat/render_command.h"
#include "apps/edgesplat/rerun_command.h"
#include "apps/edgesplat/scene_command.h"
#include "apps/option_pages.h"
#include "apps/version.h"

void add_commands(CLI::App& app, const std::string& command_line, int& exit_status) {
    app.set_version_flag("--version", version_text("edgesplat"));
    add_page_options(app, EDGESPLAT_VERSION);
    app.formatter(std::make_shared<HelpFormatter>());
    app.require_subcommand(1);
    add_device_list(app);
    add_render_command(app, command_line);
    add_rerun_command(app, command_line);
    add_scene_command(app, exit_status);
    add_movie_command(app, exit_status);
    add_info_command(app);
    add_check_command(app, exit_status);
    add_measure_command(app);
    add_pack_command(app, exit_status);
    add_compare_command(app, exit_status);
    add_footprints_command(app);
    add_effects_command(app);
    add_accuracy_command(app, command_line, exit_status);
    add_bench_command(app, command_line, exit_status);
    app.footer(
        "Examples:\n"
        "  edgesplat render builtin:sphere -o sphere.png --compare plain\n"
        "  edgesplat info head.nrrd\n"
        "  edgesplat render head.nrrd --iso -400 -o head.png\n"
        "  edgesplat compare new.png old.png --max-diff 0.01\n"
        "Each command has its own --help.");
}
