// Collects faults and puts them into the order of the files.
#include "core/formats/xml/faults.h"

#include <algorithm>

namespace mote::core {
namespace {

constexpr std::size_t max_faults = 1000;

std::string headline(const std::vector<InputError>& errors) {
    std::string text = errors.front().what();
    const std::size_t more = errors.size() - 1;
    if (more > 0) text += " (and " + std::to_string(more) + (more == 1 ? " more error)" : " more errors)");
    return text;
}

std::vector<InputError> in_file_order(const std::vector<Fault>& faults,
                                      const std::vector<std::string>& files) {
    const auto rank = [&](const InputError& e) {  // what is of no file, the command line, comes first
        const auto it = std::find(files.begin(), files.end(), e.where().file);
        return it == files.end() ? std::ptrdiff_t(-1) : it - files.begin();
    };
    std::vector<InputError> errors;
    std::set<std::string> seen;  // what several refer to is reported once
    for (const Fault& fault : faults)
        if (seen.insert(fault.error.what()).second) errors.push_back(fault.error);
    std::stable_sort(errors.begin(), errors.end(), [&](const InputError& a, const InputError& b) {
        return std::pair(rank(a), a.where().line) < std::pair(rank(b), b.where().line);
    });
    return errors;
}

}  // namespace

SceneErrors::SceneErrors(std::vector<InputError> errors)
    : InputError(headline(errors)), errors_(std::move(errors)) {}

void Faults::add(const Element* element, InputError error) {
    faults_.push_back({element, std::move(error)});
    if (element) elements_.insert(element);
    if (faults_.size() >= max_faults) throw_all({});
}

void Faults::throw_all(const std::vector<std::string>& files) const {
    if (faults_.empty()) return;
    std::vector<InputError> errors = in_file_order(faults_, files);
    if (errors.size() == 1) throw InputError(errors.front());
    throw SceneErrors(std::move(errors));
}

}  // namespace mote::core
