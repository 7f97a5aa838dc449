// A .pbrt file as tokens: words, quoted strings and brackets, each with its line; comments are skipped.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/objects/error.h"

namespace mote::core {

struct PbrtToken {
    std::string text;     ///< of a string without its quotes, escapes resolved
    bool quoted = false;  ///< a string
    int line = 0;
};

class PbrtText {
  public:
    /// `file`: its name in messages.
    PbrtText(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

    /// Nothing at the end of the file. Throws InputError for a string without an end.
    std::optional<PbrtToken> next();
    /// Throws InputError, with `what` is expected, at the end of the file.
    PbrtToken require(const char* what);
    /// The next token is returned once more by next().
    void put_back(PbrtToken token) { returned_ = std::move(token); }
    SourceLocation where(int line) const { return {file_, line}; }
    SourceLocation where() const { return {file_, line_}; }  ///< of the last token

  private:
    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    void skip_space_and_comments();
    PbrtToken quoted_string();

    std::string text_, file_;
    std::size_t at_ = 0;
    int line_ = 1;
    std::optional<PbrtToken> returned_;
};

/// The number that the word is. Throws InputError for anything else, NaN and infinity included.
double pbrt_number(std::string_view word, const SourceLocation& where);

/// The bytes of a file; those of a gzip file (by its first two bytes) unpacked. Throws InputError.
std::string read_pbrt_file(const std::string& path);

}  // namespace mote::core
