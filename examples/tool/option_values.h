#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hbar::tool {

/// Values of the options that were given, by name.
using Given = std::map<std::string, std::string>;

/// Throws a ProgramError (kUsage).
[[noreturn]] void usage(const std::string& message);

/// The text of an option, if it was given.
[[nodiscard]] std::optional<std::string> value_of(const Given& given, const std::string& name);

// Each of the following reads one option, returns nothing if it was not given, and throws a
// ProgramError (kUsage) that names the option if its text is not what it should be.

/// A number > 0.
[[nodiscard]] std::optional<double> positive_number(const Given& given, const std::string& name);
/// A whole number from 1 to `most`.
[[nodiscard]] std::optional<int> count(const Given& given, const std::string& name, int most);
/// A list of whole numbers from 1 to `most`, at least one.
[[nodiscard]] std::optional<std::vector<int>> counts(const Given& given, const std::string& name,
                                                     int most);
/// A list of numbers.
[[nodiscard]] std::optional<std::vector<double>> numbers(const Given& given,
                                                         const std::string& name);
/// A list of names, at least one.
[[nodiscard]] std::optional<std::vector<std::string>> words(const Given& given,
                                                            const std::string& name);
/// A file's or a folder's name, which is not empty.
[[nodiscard]] std::optional<std::string> file(const Given& given, const std::string& name);

/// Throws a ProgramError (kUsage) that suggests the nearest name unless `text` is one of them.
void check_name(const std::string& option, const std::string& text,
                const std::vector<std::string>& names);

/// Names of integrators().
[[nodiscard]] std::vector<std::string> integrator_names();

}  // namespace hbar::tool
