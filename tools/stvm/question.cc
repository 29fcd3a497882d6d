#include "tools/stvm/question.h"

#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

namespace stvm {

bool can_ask() { return ::isatty(STDIN_FILENO) != 0; }

base::Status ask(const char* question, const std::string& otherwise) {
  if (!can_ask()) {
    return base::Error{base::Refusal::kUsage, "nobody to ask: not a terminal; give --yes"};
  }
  // What was typed before the question, for another one perhaps, is no answer to it (E8); nor is
  // an end of input that answered the last one.
  ::tcflush(STDIN_FILENO, TCIFLUSH);
  std::clearerr(stdin);
  std::cin.clear();
  std::fprintf(stderr, "%s [y/N] ", question);
  std::string answer;
  std::getline(std::cin, answer);
  if (answer == "y" || answer == "Y" || answer == "yes") return base::Ok{};
  return base::Error{base::Refusal::kBusy, otherwise};
}

}  // namespace stvm
