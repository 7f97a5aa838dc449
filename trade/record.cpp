// Records as CSV and back. The columns are listed once, each with how it is written and read.
#include "trade/record.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <map>

#include "core/objects/error.h"

namespace mote::trade {

namespace {

using core::InputError;

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + "\"";
}

std::string number_text(double v) { return std::isnan(v) ? "" : fmt::format("{}", v); }

double to_number(const std::string& text) {
    if (text.empty()) return unknown;
    char* end = nullptr;
    const double v = std::strtod(text.c_str(), &end);
    if (*end != '\0') throw InputError("'" + core::printable(text) + "' is not a number");
    return v;
}

std::uint64_t to_count(const std::string& text) {
    const double v = to_number(text);
    if (!(v >= 0.0 && v < 9e15) || v != std::floor(v))
        throw InputError("'" + core::printable(text) + "' is not a whole number");
    return std::uint64_t(v);
}

struct Column {
    const char* name;
    std::function<std::string(const Record&)> write;
    std::function<void(Record&, const std::string&)> read;
};

Column text_column(const char* name, std::string Record::*member) {
    return {name, [member](const Record& r) { return quoted(r.*member); },
            [member](Record& r, const std::string& text) { r.*member = text; }};
}
Column number_column(const char* name, double Record::*member) {
    return {name, [member](const Record& r) { return number_text(r.*member); },
            [member](Record& r, const std::string& text) { r.*member = to_number(text); }};
}
template <typename T>
Column count_column(const char* name, T Record::*member) {
    return {name, [member](const Record& r) { return fmt::format("{}", std::uint64_t(r.*member)); },
            [member](Record& r, const std::string& text) { r.*member = T(to_count(text)); }};
}

std::vector<Column> columns() {
    return {text_column("method", &Record::method),
            text_column("integrator", &Record::integrator),
            text_column("settings", &Record::settings),
            count_column("seed", &Record::seed),
            count_column("passes", &Record::passes),
            number_column("wall_s", &Record::wall),
            number_column("cpu_s", &Record::cpu),
            number_column("build_s", &Record::build),
            number_column("error", &Record::error),
            number_column("error_se", &Record::error_se),
            number_column("stated_low", &Record::stated_low),
            number_column("stated_high", &Record::stated_high),
            number_column("relmse", &Record::relmse),
            number_column("relmse_trimmed", &Record::relmse_trimmed),
            number_column("bias", &Record::bias),
            number_column("bias_se", &Record::bias_se),
            count_column("non_finite", &Record::non_finite),
            number_column("peak_memory_mb", &Record::peak_memory_mb),
            count_column("final", &Record::final),
            count_column("below_reference", &Record::below_reference)};
}

struct Row {
    std::vector<std::string> fields;
    int line = 0;
};

// Rows of fields; quoted fields may hold commas, quotes and line ends.
std::vector<Row> parse_rows(const std::string& text, const std::string& path) {
    std::vector<Row> rows;
    Row row{{""}, 1};
    bool inside = false, any = false;
    int line = 1;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (inside) {
            if (c == '"' && i + 1 < text.size() && text[i + 1] == '"')
                row.fields.back() += text[++i];
            else if (c == '"')
                inside = false;
            else
                row.fields.back() += c;
        } else if (c == '"') {
            inside = any = true;
        } else if (c == ',') {
            row.fields.emplace_back(), any = true;
        } else if (c == '\n') {
            if (any) rows.push_back(row);
            row = {{""}, line + 1}, any = false;
        } else if (c != '\r') {
            row.fields.back() += c, any = true;
        }
        line += c == '\n';
    }
    if (inside) throw InputError("a quoted field has no end", {path, row.line});
    if (any) rows.push_back(row);
    return rows;
}

std::vector<Column> columns_in_order(const Row& header, const std::string& path) {
    std::map<std::string, Column> missing;
    std::vector<std::string> names;
    for (const Column& c : columns()) missing.emplace(c.name, c), names.emplace_back(c.name);
    std::vector<Column> order;
    for (const std::string& name : header.fields) {
        auto node = missing.extract(name);
        if (node.empty())
            throw InputError(
                "unknown or repeated column '" + core::printable(name) + "'" + core::suggestion(name, names),
                {path, header.line});
        order.push_back(node.mapped());
    }
    for (const char* name : {"method", "seed", "passes", "wall_s", "error"})
        if (missing.count(name))
            throw InputError(std::string("there is no column '") + name + "'", {path, header.line});
    return order;
}

}  // namespace

std::string to_csv(std::span<const Record> records) {
    const std::vector<Column> all = columns();
    std::string text;
    for (const Column& c : all) text += (text.empty() ? "" : ",") + std::string(c.name);
    text += "\n";
    for (const Record& r : records) {
        std::string row;
        for (const Column& c : all) row += (&c == &all.front() ? "" : ",") + c.write(r);
        text += row + "\n";
    }
    return text;
}

std::vector<Record> records_from_csv(const std::string& text, const std::string& path) {
    const std::vector<Row> rows = parse_rows(text, path);
    if (rows.empty()) throw InputError("there is no header row", {path, 1});
    const std::vector<Column> order = columns_in_order(rows.front(), path);
    std::vector<Record> records;
    for (auto row = std::next(rows.begin()); row != rows.end(); ++row) {
        if (row->fields.size() != order.size())
            throw InputError(fmt::format("{} fields, but {} columns", row->fields.size(), order.size()),
                             {path, row->line});
        Record r;
        r.cpu = r.build = r.peak_memory_mb = unknown;  // other programs need not report them
        for (std::size_t i = 0; i < order.size(); ++i) {
            try {
                order[i].read(r, row->fields[i]);
            } catch (const InputError& error) {
                throw InputError(std::string(order[i].name) + ": " + error.what(), {path, row->line});
            }
        }
        if (!(r.wall > 0.0) || !std::isfinite(r.wall))
            throw InputError("wall_s must be above 0", {path, row->line});
        records.push_back(std::move(r));
    }
    return records;
}

}  // namespace mote::trade
