// A scene that is built in memory, element by element as it would stand in a scene file: hosts that have
// objects instead of text call this, and everything else (defaults, references, checks, messages) is the
// scene language's.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/formats/xml/xml_reader.h"
#include "session/array_objects.h"

namespace mote::session {

class SceneTree {
  public:
    /// `name` replaces that of a file in messages, with the names of the objects behind it:
    /// "scene.floor.bsdf". Relative file names are looked up in `folder`.
    explicit SceneTree(std::string name = "scene", std::string folder = "");
    /// Replaces name and folder, also of the objects that are in it already.
    void place(const std::string& name, const std::string& folder);

    /// Opens an object inside the one that is open: <category type="type" name="name" id="id">. Empty: no
    /// such attribute; `label` is what messages call it, its name where that is empty. Throws InputError for
    /// an unknown category.
    void begin(const std::string& category, const std::string& type, const std::string& name = "",
               const std::string& id = "", const std::string& label = "");
    /// Closes the object that was opened last. Throws InputError where none is open.
    void end();
    /// A value of the open object: <kind name="name" value="text">, such as "float" and "0.5", "rgb" and "1 0
    /// 0".
    void value(const std::string& kind, const std::string& name, const std::string& text);
    void number(const std::string& name, double number);
    void integer(const std::string& name, std::int64_t number);
    void boolean(const std::string& name, bool state);
    /// "rgb", "point" or "vector".
    void triple(const std::string& kind, const std::string& name, double x, double y, double z);
    /// 16 numbers row by row, acting on column vectors.
    void transform(const std::string& name, std::span<const double> rows);
    /// <ref>: the object with this id, under a name or none.
    void reference(const std::string& id, const std::string& name = "");
    /// Arrays that the scene's `arraymesh` and `arraygrid` name.
    ArrayStore& arrays() { return *arrays_; }

    /// The elements, for the loader. Throws InputError where an object is still open.
    core::SceneDocument document() const;
    /// Shared arrays(), for the registry.
    const std::shared_ptr<ArrayStore>& array_store() const { return arrays_; }
    const std::string& name() const { return name_; }  ///< in messages
    /// Hash of the elements and arrays: equal where they are. 16 hexadecimal digits.
    std::string checksum() const;

  private:
    core::Element& open();
    core::Element made(const std::string& tag) const;

    std::string name_, folder_;
    core::Element scene_;
    std::vector<std::size_t> path_;    ///< indices of the children that are open
    std::vector<std::string> labels_;  ///< of the open objects
    std::shared_ptr<ArrayStore> arrays_ = std::make_shared<ArrayStore>();
};

}  // namespace mote::session
