#include "tests/differential/constructs.h"

#include <algorithm>
#include <string_view>

namespace differential {
namespace {

// A program has the construct when one of its lines holds all of the words.
struct Row {
  const char* name;
  std::initializer_list<std::string_view> words;
};

const Row kRows[] = {
    // Types and variables.
    {"enumeration", {" : (Lit"}},
    {"enumeration with a base", {"INT (Lit"}},
    {"qualified literal", {"Enum", "#Lit"}},
    {"subrange", {"Range", " : ", "("}},
    {"structure", {": STRUCT"}},
    {"structure that extends one", {" EXTENDS Struct"}},
    {"BIT member", {" : BIT"}},
    {"UNION", {": UNION"}},
    {"OVERLAP", {"STRUCT OVERLAP"}},
    {"array of two dimensions", {"ARRAY[", "..", ", ", "..", "] OF"}},
    {"array with function blocks", {"ARRAY[", "] OF Block"}},
    {"structure with function blocks", {" : Holder"}},
    {"structure that refers to its type", {" TO Node"}},
    {"list as initial value", {":= ["}},
    {"POINTER TO", {": POINTER TO "}},
    {"REF_TO", {": REF_TO "}},
    {"REFERENCE TO", {": REFERENCE TO "}},
    {"POINTER TO a function block", {": POINTER TO Block"}},
    {"pointer to a pointer", {"POINTER TO POINTER TO"}},
    {"open array", {"ARRAY[*] OF"}},
    {"ANY_NUM", {": ANY_NUM"}},
    {"VAR_TEMP", {"VAR_TEMP"}},
    {"VAR_STAT", {"VAR_STAT"}},
    {"VAR_INST", {"VAR_INST"}},
    {"reference with an initial value", {" : POINTER TO", " := ADR("}},
    {"REFERENCE TO with an initial value", {" : REFERENCE TO", " REF= "}},
    {"VAR_EXTERNAL", {"VAR_EXTERNAL"}},
    {"VAR_IN_OUT", {"VAR_IN_OUT"}},
    {"VAR RETAIN", {"VAR RETAIN"}},
    {"VAR CONSTANT", {"VAR CONSTANT"}},
    {"VAR_GLOBAL RETAIN", {"VAR_GLOBAL RETAIN"}},
    {"list of globals", {"{attribute 'list'"}},
    {"R_EDGE", {"R_EDGE"}},
    {"F_EDGE", {"F_EDGE"}},
    {"AT %Q", {" AT %QX"}},
    {"variables that share bytes", {"  g", " AT %M"}},
    // References.
    {"ADR", {"ADR("}},
    {"REF", {"REF("}},
    {"REF=", {" REF= "}},
    {"NULL", {":= NULL"}},
    {"p[i]", {"p", "[LIMIT("}},
    {"sum of a pointer", {":= p", " + SIZEOF("}},
    {"pointer led back over its end", {":= p", " - SIZEOF("}},
    {"__ISVALIDREF", {"__ISVALIDREF("}},
    // Statements.
    {"IF", {"IF ", " THEN"}},
    {"ELSIF", {"ELSIF "}},
    {"CASE", {"CASE "}},
    {"CASE with a range", {"..", ":"}},
    {"FOR with BY", {"FOR ", " BY "}},
    {"WHILE", {"WHILE "}},
    {"REPEAT", {"REPEAT"}},
    {"EXIT", {"EXIT;"}},
    {"CONTINUE", {"CONTINUE;"}},
    {"RETURN", {"RETURN;"}},
    {"JMP", {"JMP label"}},
    {"S=", {" S= "}},
    {"R=", {" R= "}},
    {"byte of a word", {".%B"}},
    {"word of a word", {".%W"}},
    {"double word of a word", {".%D"}},
    {"bit with %X", {".%X"}},
    {"__TRY", {"__TRY"}},
    {"__CATCH", {"__CATCH"}},
    {"__CATCH with a variable", {"__CATCH("}},
    {"__FINALLY", {"__FINALLY"}},
    // Calls.
    {"EN", {"EN := "}},
    {"ENO", {"ENO => "}},
    {"EN of a method", {".Do", "(EN := "}},
    {"NOT out =>", {"NOT v", " => "}},
    {"function block as in-out", {"v", " : Block"}},
    {"overload", {"Over("}},
    {"declared recursion", {"{attribute 'recursion_depth'"}},
    {"recursive call", {"Deep", "depth - 1"}},
    {"recursive method", {"THIS^.Down", "depth - 1"}},
    // Objects.
    {"METHOD", {"METHOD Do"}},
    {"METHOD PROTECTED", {"METHOD PROTECTED"}},
    {"METHOD OVERRIDE", {"OVERRIDE Do"}},
    {"METHOD ABSTRACT", {"METHOD ABSTRACT"}},
    {"FUNCTION_BLOCK ABSTRACT", {"FUNCTION_BLOCK ABSTRACT"}},
    {"FUNCTION_BLOCK FINAL", {"FUNCTION_BLOCK FINAL"}},
    {"CLASS", {"CLASS ", "IMPLEMENTS"}},
    {"EXTENDS", {"FUNCTION_BLOCK", " EXTENDS Class"}},
    {"IMPLEMENTS", {" IMPLEMENTS Contract"}},
    {"INTERFACE", {"INTERFACE Contract"}},
    {"INTERFACE EXTENDS", {"INTERFACE Contract", " EXTENDS "}},
    {"PROPERTY", {"PROPERTY Prop"}},
    {"property that is written", {".Prop", " := "}},
    {"ACTION", {"ACTION Act"}},
    {"call of an action", {".Act", "();"}},
    {"THIS^", {"THIS^."}},
    {"SUPER^.m()", {"SUPER^.Do"}},
    {"SUPER^()", {"SUPER^();"}},
    {"call through an interface", {"itf", ".Do"}},
    {"property through an interface", {"itf", ".Prop"}},
    {"call through a reference to the base", {"base", "^.Do"}},
    {"body through a reference to the base", {"base", "^("}},
    {"method of an element", {"].Do"}},
    {"?=", {" ?= "}},
    {"__QUERYINTERFACE", {"__QUERYINTERFACE("}},
    {"__QUERYPOINTER", {"__QUERYPOINTER("}},
    {"chain of calls", {".Self", "().Do"}},
    {"FB_Init", {"METHOD FB_Init"}},
    {"FB_Init of the base", {"SUPER^.FB_Init("}},
    {"FB_Init with arguments", {" : Class", "(", ");"}},
    {"FB_Init with named arguments", {" : Block", "(v", " := "}},
    {"NAMESPACE", {"NAMESPACE Space"}},
    {"NAMESPACE in another", {"NAMESPACE Space0.Deep"}},
    {"whole name", {" : Space"}},
    {"USING", {"USING Space"}},
    {"EXTENDS of a whole name", {" EXTENDS Space"}},
    // Charts.
    {"INITIAL_STEP", {"INITIAL_STEP "}},
    {"several steps begin together", {"TRANSITION", " TO (Step"}},
    {"several steps end together", {"TRANSITION", "FROM (Step"}},
    {"task with buffers of its own", {"'input_buffer'"}},
    {"task with buffers of outputs", {"'output_buffer'"}},
    {"task with an exchange of its own", {"'exchange'"}},
    {"transition with a priority", {"TRANSITION", "(PRIORITY"}},
    {"transition as a list", {"TRANSITION", " : LD "}},
    {"S.T", {"Step", ".T >= "}},
    {"S.X", {"Step", ".X"}},
    {"A.Q", {"Act", ".Q"}},
    {"qualifier N", {"(N);"}},
    {"qualifier R", {"(R);"}},
    {"qualifier S", {"(S);"}},
    {"qualifier L", {"(L, T#"}},
    {"qualifier D", {"(D, T#"}},
    {"qualifier P", {"(P);"}},
    {"qualifier P0", {"(P0);"}},
    {"qualifier P1", {"(P1);"}},
    {"qualifier SD", {"(SD, T#"}},
    {"qualifier DS", {"(DS, T#"}},
    {"qualifier SL", {"(SL, T#"}},
    // Instruction lists.
    {"LD", {"  LD "}},
    {"LDN", {"  LDN "}},
    {"ST", {"  ST "}},
    {"STN", {"  STN "}},
    {"S of a list", {"  S v"}},
    {"R of a list", {"  R v"}},
    {"ANDN", {"  ANDN "}},
    {"AND(", {"  AND( "}},
    {"XORN", {"  XORN "}},
    {"ADD(", {"  ADD( "}},
    {"MOD of a list", {"  MOD "}},
    {"GT of a list", {"  GT "}},
    {"CAL", {"  CAL "}},
    {"CALC", {"  CALC "}},
    {"CALCN", {"  CALCN "}},
    {"JMPC", {"  JMPC "}},
    {"JMPCN", {"  JMPCN "}},
    {"RETC", {"  RETC"}},
    {"function of the current result", {"  LIMIT "}},
    // Configuration.
    {"TASK", {"TASK Task0"}},
    {"program called by another", {"  Side("}},
    {"SINGLE", {"SINGLE := "}},
    {"connection in", {"PROGRAM Run", ":= "}},
    {"connection out", {"PROGRAM Run", "=> "}},
    {"function block with its own task", {"PROGRAM Run", " WITH Own"}},
    {"VAR_ACCESS", {"VAR_ACCESS"}},
    {"VAR_CONFIG", {"VAR_CONFIG"}},
    {"VAR_CONFIG with an address", {" AT %M", " : "}},
    {"AT %M*", {" AT %M", "*"}},
};

bool holds(std::string_view line, const Row& row) {
  size_t at = 0;
  for (std::string_view word : row.words) {
    at = line.find(word, at);
    if (at == std::string_view::npos) return false;
    at += word.size();
  }
  return true;
}

bool occurs(const std::string& source, const Row& row) {
  std::string_view first = *row.words.begin();
  for (size_t at = source.find(first); at != std::string::npos;) {
    size_t begin = source.rfind('\n', at) + 1;
    size_t end = std::min(source.find('\n', at), source.size());
    if (holds(std::string_view(source).substr(begin, end - begin), row)) return true;
    at = source.find(first, end);
  }
  return false;
}

}  // namespace

std::vector<ConstructCount> no_constructs() {
  std::vector<ConstructCount> out;
  for (const Row& row : kRows) out.push_back({row.name, 0});
  return out;
}

void count_constructs(const std::string& source, std::vector<ConstructCount>& counts) {
  for (size_t i = 0; i < counts.size(); ++i) {
    if (occurs(source, kRows[i])) ++counts[i].programs;
  }
}

}  // namespace differential
