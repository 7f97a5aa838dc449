// Tokens of pbrt-v4's language (its parser.cpp), and gzip.
#include "core/formats/pbrt/pbrt_text.h"

#include <zlib.h>

#include <charconv>
#include <cmath>

#include "core/files/whole_file.h"

namespace mote::core {
namespace {

constexpr std::size_t max_unpacked = std::size_t(1) << 31;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::string unpack(const std::vector<std::byte>& bytes, const std::string& path) {
    z_stream stream{};
    if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) throw InputError("zlib cannot start", {path, 0});
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
    stream.avail_in = uInt(bytes.size());
    std::string text;
    int status = Z_OK;
    while (status == Z_OK && text.size() < max_unpacked) {
        char block[1 << 16];
        stream.next_out = reinterpret_cast<Bytef*>(block), stream.avail_out = sizeof block;
        status = inflate(&stream, Z_NO_FLUSH);
        text.append(block, sizeof block - stream.avail_out);
        if (status == Z_OK && stream.avail_in == 0 && stream.avail_out > 0) break;
    }
    inflateEnd(&stream);
    if (text.size() >= max_unpacked) throw InputError("unpacks to more than 2 GiB", {path, 0});
    if (status != Z_STREAM_END) throw InputError("the gzip data is damaged or ends too early", {path, 0});
    return text;
}

}  // namespace

void PbrtText::skip_space_and_comments() {
    for (; at_ < text_.size(); ++at_) {
        if (text_[at_] == '#')
            while (at_ < text_.size() && text_[at_] != '\n') ++at_;
        if (at_ == text_.size() || !is_space(text_[at_])) return;
        if (text_[at_] == '\n') ++line_;
    }
}

PbrtToken PbrtText::quoted_string() {
    PbrtToken token{"", true, line_};
    for (++at_; at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n'; ++at_) {
        if (text_[at_] == '\\' && at_ + 1 < text_.size()) {
            const char c = text_[++at_];
            token.text += c == 'n' ? '\n' : c == 't' ? '\t' : c;
        } else {
            token.text += text_[at_];
        }
    }
    if (peek() != '"') throw InputError("a string does not end", where());
    ++at_;
    return token;
}

std::optional<PbrtToken> PbrtText::next() {
    if (returned_) {
        std::optional<PbrtToken> token;
        token.swap(returned_);
        return token;
    }
    skip_space_and_comments();
    if (at_ == text_.size()) return std::nullopt;
    if (text_[at_] == '"') return quoted_string();
    const std::size_t begin = at_;
    const auto ends = [](char c) { return is_space(c) || c == '"' || c == '[' || c == ']'; };
    do ++at_;
    while (at_ < text_.size() && !ends(text_[at_]) && text_[begin] != '[' && text_[begin] != ']');
    return PbrtToken{text_.substr(begin, at_ - begin), false, line_};
}

PbrtToken PbrtText::require(const char* what) {
    auto token = next();
    if (!token) throw InputError(std::string("the file ends where ") + what + " is expected", where());
    return *std::move(token);
}

double pbrt_number(std::string_view word, const SourceLocation& where) {
    double value = 0.0;
    const std::string_view digits = word.substr(!word.empty() && word.front() == '+' ? 1 : 0);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !(std::fabs(value) < 3.4e38))
        throw InputError("'" + printable(word, 40) + "' is no number", where);
    return value;
}

std::string read_pbrt_file(const std::string& path) {
    try {
        const std::vector<std::byte> bytes = read_whole_file(path);
        if (bytes.size() > 2 && bytes[0] == std::byte(0x1f) && bytes[1] == std::byte(0x8b))
            return unpack(bytes, path);
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    } catch (const InputError& error) {
        if (!error.where().file.empty()) throw;
        throw InputError(error.what(), {path, 0});
    }
}

}  // namespace mote::core
