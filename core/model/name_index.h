#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace hbar {

/// Which item has a name: names of one kind, all different, in the order in which they were added.
class NameIndex {
 public:
  /// Gives the next index to a name. The name must not be there yet.
  void add(std::string name) {
    const int next = static_cast<int>(index_.size());
    index_.emplace(std::move(name), next);
  }
  [[nodiscard]] bool contains(std::string_view name) const { return index_.contains(name); }
  /// The index of a name; nothing if there is no such name.
  [[nodiscard]] std::optional<int> find(std::string_view name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view name) const {
      return std::hash<std::string_view>()(name);
    }
  };
  std::unordered_map<std::string, int, Hash, std::equal_to<>> index_;
};

}  // namespace hbar
