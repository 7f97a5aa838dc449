// Errors of a scene: collected while the loader continues, so that one run reports all of them.
//
// A fault belongs to an element of the scene, or to none (the command line). A check that finds one continues
// with the next element; an object with a fault below it is not made, and neither are those that need it,
// without a further word. Nothing but throw_all() throws for a scene's fault.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/formats/xml/scene_element.h"

namespace mote::core {

/// All that is wrong with a scene, in the order of its files. what() is the first of it, and how many more.
class SceneErrors : public InputError {
  public:
    /// `errors`: at least one.
    explicit SceneErrors(std::vector<InputError> errors);
    const std::vector<InputError>& all() const { return errors_; }

  private:
    std::vector<InputError> errors_;
};

struct Fault {
    const Element* element;  ///< null: not of the file
    InputError error;
};

class Faults {
  public:
    /// Throws SceneErrors with the 1000th: more would be no help.
    void add(const Element* element, InputError error);
    /// Runs f and takes up the InputError that it may throw. Returns whether there was none.
    template <typename F>
    bool attempt(const Element& element, F&& f) {
        try {
            f();
            return true;
        } catch (const InputError& error) {
            add(&element, error);
            return false;
        }
    }
    bool has(const Element& element) const { return elements_.count(&element) > 0; }
    bool empty() const { return faults_.empty(); }
    const std::vector<Fault>& all() const { return faults_; }
    /// Throws SceneErrors (for one error that InputError itself) unless empty. `files`: in the order read.
    void throw_all(const std::vector<std::string>& files) const;

  private:
    std::vector<Fault> faults_;
    std::set<const Element*> elements_;
};

}  // namespace mote::core
