// Options::parse: every mistake is one line that says which option, what was given and the way out.
#include <algorithm>

#include "base/joined.h"
#include "base/nearest_name.h"
#include "tools/common/option_rows.h"

namespace tools {
namespace {

const OptionRow* find_row(std::span<const OptionRow> rows, std::string_view given) {
  for (const OptionRow& row : rows) {
    if (given == long_name(row) || given == short_name(row)) return &row;
  }
  return nullptr;
}

const OptionRow* find_row(const Command& command, std::string_view given) {
  const OptionRow* const own = find_row(command.options, given);
  return own != nullptr ? own : find_row(kEveryCommand, given);
}

}  // namespace

class OptionParser {
 public:
  OptionParser(const Command& command, std::span<char* const> args)
      : command_(command), args_(args) {}

  base::Result<Options> run() {
    for (; at_ < args_.size(); ++at_) {
      base::Status taken = take(args_[at_]);
      if (!taken.ok()) return taken.error();
    }
    base::Status together = check_together();
    if (!together.ok()) return together.error();
    const std::vector<std::string>& arguments = out_.arguments_;
    if (arguments.size() < command_.min_arguments) {
      return usage({"needs ", command_.arguments});
    }
    if (arguments.size() > command_.max_arguments) {
      return usage({"too many arguments: ", arguments[command_.max_arguments]});
    }
    return std::move(out_);
  }

 private:
  base::Error usage(std::initializer_list<std::string_view> parts) const {
    return {base::Refusal::kUsage, base::joined({command_.name, ": ", base::joined(parts)})};
  }

  base::Status take(std::string_view arg) {
    if (ended_ || arg.size() < 2 || arg[0] != '-') {
      out_.arguments_.emplace_back(arg);
      return base::Ok{};
    }
    if (arg == "--") {
      ended_ = true;
      return base::Ok{};
    }
    return arg[1] == '-' ? take_long(arg) : take_short(arg);
  }

  base::Status take_long(std::string_view arg) {
    const size_t equals = arg.find('=');
    const std::string_view given = arg.substr(0, equals);
    const OptionRow* row = find_row(command_, given);
    if (row == nullptr) return unknown(given);
    if (equals == std::string_view::npos) return row->value ? take_next(*row, given) : flag(*row);
    if (row->value == nullptr) return usage({given, " takes no value"});
    return keep(*row, arg.substr(equals + 1));
  }

  // "-o FILE", "-oFILE", "-q", "-qj2".
  base::Status take_short(std::string_view arg) {
    for (size_t i = 1; i < arg.size(); ++i) {
      const std::string given = {'-', arg[i]};
      const OptionRow* row = find_row(command_, given);
      if (row == nullptr) return unknown(i == 1 ? arg : given);
      const std::string_view rest = arg.substr(i + 1);
      if (row->value == nullptr) {
        if (base::Status taken = flag(*row); !taken.ok()) return taken;
      } else if (rest.empty()) {
        return take_next(*row, given);
      } else if (rest[0] == '=') {
        return usage({arg, ": write ", given, " ", rest.substr(1), ", or ", long_name(*row), rest});
      } else {
        return keep(*row, rest);
      }
    }
    return base::Ok{};
  }

  // What looks like an option of this command is none of its values: that one was forgotten.
  base::Status take_next(const OptionRow& row, std::string_view given) {
    const std::string_view next = at_ + 1 < args_.size() ? args_[at_ + 1] : "";
    if (at_ + 1 == args_.size()) return usage({given, " needs a value: ", row.value});
    if (next.starts_with('-') && find_row(command_, next.substr(0, next.find('='))) != nullptr) {
      return usage({given, " needs a value: ", row.value, ", and ", next,
                    " is an option; if it is meant, write ", long_name(row), "=", next});
    }
    ++at_;
    return keep(row, next);
  }

  base::Status flag(const OptionRow& row) {
    out_.values_[std::string(long_name(row))] = {""};
    return base::Ok{};
  }

  base::Status keep(const OptionRow& row, std::string_view value) {
    const std::string name(long_name(row));
    const std::vector<std::string_view> choices = words_of(row.choices);
    if (!choices.empty() && std::find(choices.begin(), choices.end(), value) == choices.end()) {
      return no_choice(name, choices, value);
    }
    std::vector<std::string>& values = out_.values_[name];
    if (row.times == Times::kOnce && !values.empty()) {
      return usage(
          {name, " takes one value, and there are two: `", values[0], "` and `", value, "`"});
    }
    values.emplace_back(value);
    return base::Ok{};
  }

  base::Error no_choice(const std::string& name, const std::vector<std::string_view>& choices,
                        std::string_view value) const {
    base::NearestName nearest(value);
    std::string all;
    for (size_t i = 0; i < choices.size(); ++i) {
      nearest.offer(choices[i]);
      all += i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ";
      all += choices[i];
    }
    return usage({name, " is ", all, ", not `", value, "`", nearest.question()});
  }

  base::Error unknown(std::string_view given) const {
    // The dashes are no letters of the name.
    base::NearestName nearest(given.substr(std::min(given.find_first_not_of('-'), given.size())));
    for (const OptionRow& row : command_.options) nearest.offer(long_name(row).substr(2));
    for (const OptionRow& row : kEveryCommand) nearest.offer(long_name(row).substr(2));
    if (nearest.best().empty()) return usage({"unknown option ", given});
    return usage({"unknown option ", given, "; did you mean `--", nearest.best(), "`?"});
  }

  base::Status check_together() const {
    for (const OptionRow& row : command_.options) {
      if (!out_.has(long_name(row))) continue;
      for (std::string_view other : words_of(row.excludes)) {
        if (!out_.has(other)) continue;
        return usage({long_name(row), " and ", other, " contradict each other; leave one out"});
      }
    }
    return base::Ok{};
  }

  const Command& command_;
  std::span<char* const> args_;
  size_t at_ = 0;
  bool ended_ = false;
  Options out_;
};

base::Result<Options> Options::parse(const Command& command, std::span<char* const> args) {
  return OptionParser(command, args).run();
}

}  // namespace tools
