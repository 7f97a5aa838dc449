#include "core/parameters/parameter_list.h"

#include <algorithm>
#include <stdexcept>

#include "core/objects/registry.h"

namespace mote::core {

Row make_row(std::string name, std::string sentence, const ValueKind& kind, std::size_t offset) {
    Row row;
    row.parameter.name = std::move(name), row.parameter.description = std::move(sentence);
    row.kind = &kind, row.offset = offset;
    return row;
}

void read_rows(const std::vector<Row>& rows, const Properties& properties, void* settings) {
    for (const Row& row : rows)
        if (row.kind->given(properties, row))
            row.kind->read(properties, row, static_cast<std::byte*>(settings) + row.offset);
        else if (row.parameter.required)
            throw InputError(category_name(properties.category) + " '" + properties.type +
                                 "' needs the parameter '" + row.parameter.name + "'",
                             properties.where);
}

std::vector<Parameter> parameters_of(const std::vector<Row>& rows, const void* defaults) {
    std::vector<Parameter> result;
    for (const Row& row : rows) {
        Parameter parameter = row.parameter;
        parameter.type = row.kind->type(row);
        const void* member = static_cast<const std::byte*>(defaults) + row.offset;
        parameter.default_value = parameter.required ? "required"
                                  : row.when_absent  ? *row.when_absent
                                                     : row.kind->text(row, member);
        result.push_back(std::move(parameter));
    }
    return result;
}

std::vector<Row> moved_rows(std::vector<Row> rows, std::size_t offset) {
    for (Row& row : rows) row.offset += offset;
    return rows;
}

void remove_rows(std::vector<Row>& rows, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (std::erase_if(rows, [&](const Row& row) { return row.parameter.name == name; }) == 0)
            throw std::logic_error(std::string("no parameter is called '") + name + "'");
}

}  // namespace mote::core
