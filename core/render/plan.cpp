// Plans as people read them.
#include "core/render/plan.h"

#include <algorithm>

namespace mote::core {

namespace {

void append_table(std::string& text, const std::string& title, const std::vector<PlanEntry>& entries) {
    if (entries.empty()) return;
    std::size_t topic_width = 0, choice_width = 0;
    for (const PlanEntry& e : entries) {
        topic_width = std::max(topic_width, e.topic.size());
        choice_width = std::max(choice_width, e.choice.size());
    }
    // A long choice breaks its own line instead of pushing every reason to the right.
    choice_width = std::min<std::size_t>(choice_width, 40);
    const auto padded = [](const std::string& s, std::size_t width) {
        return s.size() < width ? s + std::string(width - s.size(), ' ') : s;
    };
    text += "\n" + title + "\n";
    for (const PlanEntry& e : entries) {
        std::string line = "  " + padded(e.topic, topic_width) + "  " + padded(e.choice, choice_width);
        if (!e.reason.empty()) line += "  " + e.reason;
        if (!e.cure.empty()) line += "; " + e.cure + " brings it back";
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
}

}  // namespace

std::string Plan::no_error_because() const {
    if (!missing.empty() && !error_by_groups) return missing.front().topic + " is missing";
    return error_unknown.empty() ? noise_unknown : error_unknown;
}

PassSplit Plan::split() const {
    if (!error_is_known()) return PassSplit::whole;
    return error_by_groups ? PassSplit::groups : PassSplit::halves;
}

void Plan::run(std::string topic, std::string choice, std::string reason) {
    runs.push_back({std::move(topic), std::move(choice), std::move(reason), ""});
}
void Plan::leave_out(std::string topic, std::string choice, std::string reason) {
    left_out.push_back({std::move(topic), std::move(choice), std::move(reason), ""});
}
void Plan::miss(std::string topic, std::string choice, std::string reason, std::string cure) {
    missing.push_back({std::move(topic), std::move(choice), std::move(reason), std::move(cure)});
}

std::vector<std::string> Plan::warnings() const {
    std::vector<std::string> lines;
    for (const std::string& text : costly) lines.push_back("warning: " + text);
    std::vector<std::pair<std::string, std::string>> by_choice;  // topic; what is left out, and its switch
    for (const PlanEntry& e : missing) {
        if (e.cure.empty()) {
            lines.push_back("warning: " + integrator + " leaves out " + e.topic + ": " + e.reason);
            continue;
        }
        const auto known = std::find_if(by_choice.begin(), by_choice.end(),
                                        [&](const auto& entry) { return entry.first == e.topic; });
        const std::string text = e.choice + " (-D " + e.cure + " brings it back)";
        if (known == by_choice.end())
            by_choice.emplace_back(e.topic, text);
        else
            known->second += "; " + text;
    }
    for (const auto& [topic, text] : by_choice)
        lines.push_back("note: " + topic + " as it is set leaves out: " + text);
    return lines;
}

std::string Plan::to_text() const {
    std::string text = "integrator: " + integrator + "\n";
    append_table(text, "runs", runs);
    append_table(text, "left out: this scene does not need it", left_out);
    append_table(text, "missing: this integrator cannot compute it", missing);
    for (const std::string& sentence : costly) text += "\nwarning: " + sentence + "\n";
    return text;
}

}  // namespace mote::core
