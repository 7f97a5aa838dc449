// Files that a pbrt scene names, files that its conversion writes, and what is reported of it.
#pragma once

#include <map>

#include "core/formats/conversion/conversion.h"
#include "core/formats/conversion/output_folder.h"

namespace mote::core {

class PbrtFiles {
  public:
    /// `scene`: takes up the report and the files read.
    PbrtFiles(std::string path, const std::filesystem::path& folder, const ConversionOptions& options,
              ConvertedScene& scene)
        : path_(std::move(path)), output_(folder), options_(options), scene_(scene) {}

    const std::string& scene() const { return path_; }
    /// Path of a file that the scene names, relative to the scene's folder. Throws InputError where there is
    /// none.
    std::string find(const std::string& name, const SourceLocation& where);
    /// That file as the XML names it: copied into the folder of the conversion where that is requested.
    std::string use(const std::string& name, const SourceLocation& where);
    /// A name for a new file in the folder: "mesh_12.ply".
    std::string new_name(const std::string& stem, const std::string& extension);
    void write(const std::string& name, std::span<const std::byte> bytes) { output_.write(name, bytes); }
    std::string path_of(const std::string& name) const { return output_.path_of(name); }
    std::string in_xml(const std::string& name) const { return options_.prefix + name; }

    /// Something that changes the picture, and what stands in its place under --lenient.
    void fault(const SourceLocation& where, const std::string& what, const std::string& done) {
        scene_.report.fault(InputError(what, where), done);
    }
    void fault(const InputError& error, const std::string& done) { scene_.report.fault(error, done); }
    void note(const std::string& text) { scene_.report.note(text); }

  private:
    std::string path_;
    OutputFolder output_;
    const ConversionOptions& options_;
    ConvertedScene& scene_;
    std::map<std::string, std::string> used_;
    std::size_t count_ = 0;
};

}  // namespace mote::core
