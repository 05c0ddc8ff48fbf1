// Prints the words of scene files as a dictionary for libFuzzer, from the vocabulary of the reader.

#include <iostream>
#include <set>
#include <string>

#include "hbar/core/scene/vocabulary.h"

int main() {
  // Numbers that are hard on arithmetic, and what XML has besides.
  std::set<std::string> words = {"0",      "-0",        "-1",         "1e-9",      "1e9",  "1e-160",
                                 "1e160",  "1e308",     "5e-324",     "nan",       "inf",  "1e999",
                                 "0 0 0",  "0 0 1",     "true",       "false",     "/>",   "<!--",
                                 "-->",    "<![CDATA[", "]]>",        "<?xml",     "&#0;", "&#x41;",
                                 "&quot;", "wedge.obj", "points.txt", "sensor.txt"};
  for (const hbar::scene::ElementInfo& element : hbar::scene::vocabulary()) {
    const std::string name(element.name);
    words.insert({"<" + name, "<" + name + ">", "</" + name + ">"});
    for (const hbar::scene::AttributeInfo& attribute : element.attributes) {
      words.insert(" " + std::string(attribute.name) + "=\"");
      for (const std::string& choice : hbar::scene::listed(attribute.choices, '|')) {
        words.insert("\"" + choice + "\"");
      }
    }
  }
  for (const std::string& word : words) {
    std::string quoted;
    for (const char letter : word) {
      quoted += letter == '"' || letter == '\\' ? std::string{'\\', letter} : std::string{letter};
    }
    std::cout << '"' << quoted << "\"\n";
  }
}
