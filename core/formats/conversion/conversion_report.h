// Content of a foreign scene that a scene of ours does not have.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/objects/error.h"

namespace mote::core {

/// Something that changes the picture: the error, and what replaces it where the reader is lenient.
struct ConversionFault {
    InputError error;
    std::string done;
};

class ConversionReport {
  public:
    /// `path`: the scene, which faults without a place of their own belong to.
    explicit ConversionReport(std::string path) : path_(std::move(path)) {}

    std::vector<ConversionFault> faults;
    std::vector<std::string> notes;  ///< information for the user that changes nothing

    /// Each once.
    void fault(const InputError& error, const std::string& done) {
        const auto same = [&](const ConversionFault& f) {
            return std::string(f.error.what()) == error.what();
        };
        if (std::none_of(faults.begin(), faults.end(), same)) faults.push_back({error, done});
    }
    void fault(const std::string& what, const std::string& done) {
        fault(InputError(what, {path_, 0}), done);
    }
    void note(const std::string& text) {
        if (std::find(notes.begin(), notes.end(), text) == notes.end()) notes.push_back(text);
    }

  private:
    std::string path_;
};

}  // namespace mote::core
