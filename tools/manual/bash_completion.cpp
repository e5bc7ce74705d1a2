// Completion for bash. SPDX-License-Identifier: Apache-2.0
#include "completions.h"

namespace gridiron::tool {
namespace {

constexpr const char* kOpening =
    R"( for bash, written by tools/manual from the options of the program.
# SPDX-License-Identifier: Apache-2.0

)";

// What does not depend on the options.
constexpr const char* kBody = R"BASH(
# Adds to COMPREPLY what begins with $1: words of $words; files that end in one of $endings, and folders.
_gridiron_offer() {
  local current=$1 prefix=${2:-} name bare files=() fitting=()
  case $words in *=) compopt -o nospace 2> /dev/null ;; esac  # what follows belongs to the word
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -P "$prefix" -W "$words" -- "$current")
  [ -n "$endings" ] || return 0
  compopt -o filenames 2> /dev/null
  current=${current//\\/}
  case $current in [\'\"]*) current=${current:1} ;; esac
  while IFS= read -r name; do
    bare=${name/#\~\//$HOME/}
    if [ -d "$bare" ]; then
      COMPREPLY+=("$prefix$name")
      continue
    fi
    files+=("$prefix$name")
    bare=${name##*.}
    case " $endings " in *" ${bare,,} "*) fitting+=("$prefix$name") ;; esac
  done < <(compgen -f -- "$current")
  # A file may have any name: all are offered where none has a usual one.
  case " $endings " in
    *' / '*) [ "$endings" = / ] || COMPREPLY+=("${fitting[@]}") ;;
    *) if [ ${#fitting[@]} -gt 0 ]; then COMPREPLY+=("${fitting[@]}"); else COMPREPLY+=("${files[@]}"); fi ;;
  esac
}

_gridiron() {
  local words='' endings='' line=() word i
  COMPREPLY=()
  # The words up to the cursor. Bash parts --option=value in three, which become one again.
  for ((i = 1; i <= COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if [ ${#line[@]} -gt 0 ] && [[ $word == '=' && ${line[-1]} == --* ]]; then
      line[-1]+='='
    elif [ ${#line[@]} -gt 0 ] && [[ ${COMP_WORDS[i - 1]} == '=' && ${line[-1]} == --*= ]]; then
      line[-1]+=$word
    else
      line+=("$word")
    fi
  done
  local current=${line[-1]} last=$((${#line[@]} - 1))
  if [ $last -eq 0 ]; then
    case $current in
      -*) words=$(_gridiron_options '') ;;
      *) words=$_gridiron_commands ;;
    esac
    _gridiron_offer "$current"
    return
  fi

  local command=${line[0]} value_of='' arguments=0 only_arguments=no given=' ' name
  for ((i = 1; i < last; ++i)); do
    word=${line[i]}
    if [ -n "$value_of" ]; then
      value_of=''
    elif [ $only_arguments = no ] && [ "$word" = -- ]; then
      only_arguments=yes
    elif [ $only_arguments = no ] && [[ $word == -?* ]]; then
      name=${word%%=*}
      given+="$name "
      if [ "$name" = "$word" ] && _gridiron_value "$command" "$name"; then value_of=$name; fi
    else
      arguments=$((arguments + 1))
    fi
  done

  if [ -n "$value_of" ]; then
    _gridiron_value "$command" "$value_of"
    _gridiron_offer "$current"
  elif [ $only_arguments = no ] && [[ $current == --*=* ]]; then
    # Where = parts no words, the reply has to begin with the option.
    local prefix=''
    case ${COMP_WORDS[COMP_CWORD]} in --*=*) prefix=${current%%=*}= ;; esac
    if _gridiron_value "$command" "${current%%=*}"; then _gridiron_offer "${current#*=}" "$prefix"; fi
  elif [ $only_arguments = no ] && [[ $current == -* ]]; then
    words=''
    endings=''
    for word in $(_gridiron_options "$command"); do
      case $given in *" $word "*) ;; *) words+="$word " ;; esac
    done
    _gridiron_offer "$current"
  elif _gridiron_value "$command" $((arguments + 1)); then
    _gridiron_offer "$current"
  elif [ $only_arguments = no ] && [ -z "$current" ]; then
    words=$(_gridiron_options "$command")
    endings=''
    _gridiron_offer "$current"
  fi
}

complete -F _gridiron )BASH";

std::string quoted(const std::string& text) {
  return "'" + text + "'";  // no name and no choice has a quote
}

// "'render --depth' | 'render --ids') words='' endings='pfm' ;;"
std::string value_row(const CommandFacts& command, const OptionFacts& option, const std::string& place) {
  std::string patterns;
  for (const std::string& name : option.is_argument() ? std::vector<std::string>{place} : option.names) {
    const bool is_any = option.is_argument() && option.takes_many;
    patterns += (patterns.empty() ? "" : " | ") +
                (is_any ? quoted(command.name + " ") + "[1-9]*" : quoted(command.name + " " + name));
  }
  std::string endings = joined(option.offer.endings, " ");
  if (option.offer.has_folders) endings += endings.empty() ? "/" : " /";
  if (option.offer.has_files && endings.empty()) endings = "*";
  std::string row = "    " + patterns + ")";
  if (!option.offer.words.empty()) row += " words=" + quoted(joined(option.offer.words, " "));
  if (!endings.empty()) row += " endings=" + quoted(endings);
  return row + " ;;\n";
}

std::string names_row(const CommandFacts& command) {
  std::vector<std::string> names;
  for (const OptionFacts& option : command.options) names.insert(names.end(), option.names.begin(), option.names.end());
  return "    " + quoted(command.name) + ") echo " + quoted(joined(names, " ")) + " ;;\n";
}

}  // namespace

std::string bash_completion(const ProgramFacts& facts, const std::string& program) {
  std::vector<std::string> commands;
  for (const CommandFacts& command : facts.commands) commands.push_back(command.name);
  std::string script = "# Completion of " + program + kOpening;
  script += "_gridiron_commands=" + quoted(joined(commands, " ")) +
            "\n\n# Prints the options of a command; of '': of the program.\n";
  script += "_gridiron_options() {\n  case $1 in\n" + names_row(facts.program);
  for (const CommandFacts& command : facts.commands) script += names_row(command);
  script += "  esac\n}\n\n";
  script +=
      "# Whether the option $2 of command $1 takes a value, or whether there is an argument number $2; sets what to "
      "offer\n"
      "# for it: words, and endings of files; / is a folder.\n"
      "_gridiron_value() {\n  words=''\n  endings=''\n  case \"$1 $2\" in\n";
  for (const CommandFacts& command : facts.commands) {
    std::size_t place = 0;
    for (const OptionFacts& argument : command.arguments)
      script += value_row(command, argument, std::to_string(++place));
    for (const OptionFacts& option : command.options) {
      if (option.takes_value) script += value_row(command, option, "");
    }
  }
  return script + "    *) return 1 ;;\n  esac\n}\n" + kBody + program + "\n";
}

}  // namespace gridiron::tool
