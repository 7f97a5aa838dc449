// Makes the object of an element through the registry, its nested objects first; every element once.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/formats/xml/element_checks.h"
#include "core/objects/properties.h"
#include "core/scene/scene.h"

namespace mote::core {

class ObjectMaker {
  public:
    /// `faults` takes up what is wrong; elements that it holds already are not made.
    ObjectMaker(const Registry& registry, const IdTable& ids, std::vector<std::string> search_paths,
                Faults& faults)
        : registry_(registry), ids_(ids), search_paths_(std::move(search_paths)), faults_(faults) {}

    /// The object of `element`, or of what a <ref> names. Null where something is wrong with it, or with an
    /// object that it needs: `faults` says what.
    std::shared_ptr<Object> make(const Element& element);
    template <typename T>
    std::shared_ptr<T> make_as(const Element& element) {
        auto object = make(element);
        auto typed = std::dynamic_pointer_cast<T>(object);
        if (object && !typed)
            faults_.add(&element,
                        InputError("<" + element.tag + "> is an object of the wrong kind", element.where));
        return typed;
    }

    FilmSettings film;                           ///< of the last sensor made
    std::vector<std::shared_ptr<Medium>> media;  ///< in the order in which shapes, lights and camera use them
    std::vector<std::string> warnings, files;

  private:
    struct Made {
        std::shared_ptr<Object> object;
        bool done = false;
    };
    std::shared_ptr<Object> make_new(const Element& element);
    std::shared_ptr<Object> make_medium(const Element& element);
    bool read_properties(const Element& element, Properties& properties);
    bool read_child(const Element& child, const Element& parent, const Manual& manual,
                    Properties& properties);
    std::shared_ptr<Medium> use_medium(const Element& element);
    bool attach(const Element& element, const Properties& properties, Object& object);
    bool attach_medium(const Element& child, const Element& element, Object& object);
    bool refuse_materials(const Element& element);
    bool attach_to_shape(const Element& element, Shape& shape);
    bool attach_part(const Element& child, Shape& shape);
    std::shared_ptr<Bsdf> default_bsdf(const Element& element, const Shape& shape);
    std::shared_ptr<Bsdf> built_in(const std::string& type, double reflectance, const Element& element);

    const Registry& registry_;
    const IdTable& ids_;
    std::vector<std::string> search_paths_;
    Faults& faults_;
    std::map<const Element*, Made> made_;
    std::map<std::string, std::shared_ptr<Bsdf>> defaults_;
    std::map<std::string, std::shared_ptr<Object>> media_by_content_;
    int depth_ = 0;
    bool too_deep_ = false;  ///< nothing more is made
};

}  // namespace mote::core
