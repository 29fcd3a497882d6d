#include "tools/stvm/question.h"

#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

namespace stvm {

namespace {

// What was typed before the question, for another one perhaps, is no answer to it (E8); nor is an
// end of input that answered the last one.
std::string answer_to(const char* question, const char* answers) {
  ::tcflush(STDIN_FILENO, TCIFLUSH);
  std::clearerr(stdin);
  std::cin.clear();
  std::fprintf(stderr, "%s %s ", question, answers);
  std::string answer;
  std::getline(std::cin, answer);
  return answer;
}

bool is_yes(const std::string& answer) { return answer == "y" || answer == "Y" || answer == "yes"; }

}  // namespace

bool can_ask() { return ::isatty(STDIN_FILENO) != 0; }

base::Status ask(const char* question, const std::string& otherwise) {
  if (!can_ask()) {
    return base::Error{base::Refusal::kUsage,
                       "cannot ask for confirmation: stdin is not a terminal; pass --yes"};
  }
  const std::string answer = answer_to(question, "[y/N]");
  if (is_yes(answer)) return base::Ok{};
  return base::Error{base::Refusal::kBusy, otherwise};
}

Answer ask_for_each(const char* question) {
  const std::string answer = answer_to(question, "[y/N/all/quit]");
  if (is_yes(answer)) return Answer::kYes;
  if (answer == "all") return Answer::kAll;
  return answer == "quit" || answer == "q" ? Answer::kQuit : Answer::kNo;
}

}  // namespace stvm
