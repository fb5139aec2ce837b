// Reads OME-XML.
#include "engine/volume/io/ome.h"

#include <array>
#include <charconv>
#include <pugixml.hpp>

#include "engine/volume/io/readers.h"
#include "engine/volume/io/samples.h"

namespace edgesplat::detail {
namespace {

/// A name without its namespace prefix.
std::string_view local_name(std::string_view name) {
    return name.substr(name.rfind(':') == std::string_view::npos ? 0 : name.rfind(':') + 1);
}

pugi::xml_node ome_child(const pugi::xml_node& parent, std::string_view name) {
    for (const pugi::xml_node child : parent.children())
        if (local_name(child.name()) == name) return child;
    return {};
}

std::optional<std::uint64_t> ome_number(const std::string& path, const pugi::xml_node& node, const char* name) {
    const pugi::xml_attribute attribute = node.attribute(name);
    if (!attribute) return std::nullopt;
    const std::string_view text = attribute.value();
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size())
        fail("{}: OME-XML: {} {}='{}': expected a whole number of at least 0", path, local_name(node.name()), name,
             text);
    return number;
}

std::uint64_t ome_size(const std::string& path, const pugi::xml_node& pixels, const char* name) {
    const auto size = ome_number(path, pixels, name);
    if (!size || *size < 1 || *size > 0x7FFFFFFF)
        fail("{}: OME-XML: Pixels {}='{}': expected a whole number of at least 1", path, name,
             pixels.attribute(name).value());
    return *size;
}

OmeImage::Length ome_length(const pugi::xml_node& pixels, const char* name) {
    const std::string unit_name = std::string(name) + "Unit";
    const pugi::xml_attribute unit = pixels.attribute(unit_name.c_str());
    return {pixels.attribute(name).value(), unit ? unit.value() : "\xc2\xb5m"};
}

OmeImage ome_image(const std::string& path, const pugi::xml_node& node) {
    OmeImage image{.id = node.attribute("ID").value(), .name = node.attribute("Name").value()};
    const pugi::xml_node pixels = ome_child(node, "Pixels");
    if (!pixels) fail("{}: OME-XML: Image '{}' has no Pixels", path, image.id);
    image.order = pixels.attribute("DimensionOrder").value();
    image.type = pixels.attribute("Type") ? pixels.attribute("Type").value() : pixels.attribute("PixelType").value();
    image.x = ome_size(path, pixels, "SizeX");
    image.y = ome_size(path, pixels, "SizeY");
    image.z = ome_size(path, pixels, "SizeZ");
    image.c = ome_size(path, pixels, "SizeC");
    image.t = ome_size(path, pixels, "SizeT");
    image.size_x = ome_length(pixels, "PhysicalSizeX");
    image.size_y = ome_length(pixels, "PhysicalSizeY");
    image.size_z = ome_length(pixels, "PhysicalSizeZ");
    for (const pugi::xml_node child : pixels.children()) {
        const std::string_view name = local_name(child.name());
        if (name == "Channel") {
            const std::string label = child.attribute("Name").value();
            image.channels.push_back(label);
            image.samples = ome_number(path, child, "SamplesPerPixel").value_or(image.samples);
        } else if (name == "BinData") {
            fail("{}: OME-XML: pixels inside the XML (BinData) are not read; expected TiffData", path);
        } else if (name == "TiffData") {
            OmeTiffData data{.directory = ome_number(path, child, "IFD"),
                             .planes = ome_number(path, child, "PlaneCount"),
                             .z = ome_number(path, child, "FirstZ").value_or(0),
                             .c = ome_number(path, child, "FirstC").value_or(0),
                             .t = ome_number(path, child, "FirstT").value_or(0)};
            if (!data.planes) data.planes = ome_number(path, child, "NumPlanes");
            const pugi::xml_node uuid = ome_child(child, "UUID");
            data.file = uuid.attribute("FileName").value();
            data.uuid = trimmed(uuid.text().get());
            image.data.push_back(std::move(data));
        }
    }
    return image;
}

}  // namespace

std::optional<double> ome_millimetres(std::string_view unit) {
    struct Prefix {
        std::string_view symbol, name;
        double factor;
    };
    constexpr std::array kPrefixes{Prefix{"Y", "yotta", 1e27},  Prefix{"Z", "zetta", 1e24}, Prefix{"E", "exa", 1e21},
                                   Prefix{"P", "peta", 1e18},   Prefix{"T", "tera", 1e15},  Prefix{"G", "giga", 1e12},
                                   Prefix{"M", "mega", 1e9},    Prefix{"k", "kilo", 1e6},   Prefix{"h", "hecto", 1e5},
                                   Prefix{"da", "deca", 1e4},   Prefix{"d", "deci", 1e2},   Prefix{"c", "centi", 1e1},
                                   Prefix{"m", "milli", 1},     Prefix{"n", "nano", 1e-6},  Prefix{"p", "pico", 1e-9},
                                   Prefix{"f", "femto", 1e-12}, Prefix{"a", "atto", 1e-15}, Prefix{"z", "zepto", 1e-18},
                                   Prefix{"y", "yocto", 1e-21}, Prefix{"u", "micro", 1e-3}};
    for (const Prefix& prefix : kPrefixes) {
        if (unit.ends_with('m') && unit.substr(0, unit.size() - 1) == prefix.symbol) return prefix.factor;
        for (const std::string_view metre : {"meter", "metre", "meters", "metres"})
            if (unit.ends_with(metre) && unit.substr(0, unit.size() - metre.size()) == prefix.name)
                return prefix.factor;
    }
    struct Unit {
        std::string_view name;
        double millimetres;
    };
    constexpr std::array kOthers{Unit{"thou", 0.0254},
                                 Unit{"li", 25.4 / 12},
                                 Unit{"yd", 914.4},
                                 Unit{"yard", 914.4},
                                 Unit{"mi", 1609344},
                                 Unit{"mile", 1609344},
                                 Unit{"pt", 25.4 / 72},
                                 Unit{"ua", 1.495978707e14},
                                 Unit{"ly", 9.4607304725808e18},
                                 Unit{"pc", 3.0856775814913673e19},
                                 Unit{"parsec", 3.0856775814913673e19},
                                 Unit{"\xe2\x84\xab", 1e-7}};
    for (const Unit& other : kOthers)
        if (unit == other.name) return other.millimetres;
    return millimetres_in(unit);
}

bool is_ome_xml(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (begin == std::string_view::npos || text[begin] != '<') return false;
    const std::string_view head = text.substr(begin, 4096);
    return head.find("<OME") != std::string_view::npos || head.find(":OME") != std::string_view::npos;
}

OmeDocument read_ome_xml(const std::string& path, const std::string& text) {
    pugi::xml_document xml;
    const pugi::xml_parse_result result = xml.load_buffer(text.data(), text.size());
    if (!result) fail("{}: its OME-XML is broken at byte {}: {}", path, result.offset, result.description());
    const pugi::xml_node root = ome_child(xml, "OME");
    if (!root) fail("{}: its OME-XML has no element OME", path);
    OmeDocument document{.uuid = root.attribute("UUID").value(),
                         .metadata_file = ome_child(root, "BinaryOnly").attribute("MetadataFile").value()};
    if (!document.metadata_file.empty()) return document;
    for (const pugi::xml_node child : root.children())
        if (local_name(child.name()) == "Image") document.images.push_back(ome_image(path, child));
    return document;
}

}  // namespace edgesplat::detail
