// Makes the object of an element through the registry, its nested objects first; every element once.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/loading/element_checks.h"
#include "core/objects/properties.h"
#include "core/scene/scene.h"

namespace mote::core {

class ObjectMaker {
  public:
    ObjectMaker(const Registry& registry, const IdTable& ids, std::vector<std::string> search_paths)
        : registry_(registry), ids_(ids), search_paths_(std::move(search_paths)) {}

    /// The object of `element`, or of what a <ref> names. Throws InputError with the element's place.
    std::shared_ptr<Object> make(const Element& element);
    template <typename T>
    std::shared_ptr<T> make_as(const Element& element) {
        auto typed = std::dynamic_pointer_cast<T>(make(element));
        if (!typed) throw InputError("<" + element.tag + "> is an object of the wrong kind", element.where);
        return typed;
    }

    FilmSettings film;                           ///< of the last sensor made
    std::vector<std::shared_ptr<Medium>> media;  ///< in the order in which shapes, lights and camera use them
    std::vector<std::string> warnings, files;

  private:
    std::shared_ptr<Object> make_new(const Element& element);
    Properties read_properties(const Element& element);
    std::shared_ptr<Medium> use_medium(const Element& element);
    void attach(const Element& element, const Properties& properties, Object& object);
    void attach_to_shape(const Element& element, Shape& shape);
    std::shared_ptr<Bsdf> default_bsdf(const Element& element, const Shape& shape);
    std::shared_ptr<Bsdf> built_in(const std::string& type, double reflectance, const Element& element);

    const Registry& registry_;
    const IdTable& ids_;
    std::vector<std::string> search_paths_;
    std::map<const Element*, std::shared_ptr<Object>> made_;
    std::map<std::string, std::shared_ptr<Bsdf>> defaults_;
    int depth_ = 0;
};

}  // namespace mote::core
