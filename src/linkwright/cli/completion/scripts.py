"""Completion scripts for bash, zsh and fish.

They call ``python -m linkwright.cli.completion``.
"""

from __future__ import annotations

import shlex
from collections.abc import Sequence

FILES = ":files"
"""The completion that makes the shell also complete file names."""

_BASH = """\
_linkwright_complete() {
  local line="${COMP_LINE:0:COMP_POINT}" IFS=$'\\n' each word
  COMPREPLY=()
  word="${line##*[[:space:]]}"
  for each in $(PYTHON -m linkwright.cli.completion --line "$line" 2>/dev/null); do
    if [ "$each" = FILES ]; then
      COMPREPLY+=($(compgen -f -- "$word"))
      compopt -o filenames 2>/dev/null
    else
      case "$word" in *[:=]*) each="${each#"${word%"${word##*[:=]}"}"}" ;; esac
      COMPREPLY+=("$each")
      case "$each" in *=) compopt -o nospace 2>/dev/null ;; esac
    fi
  done
}
complete -F _linkwright_complete COMMANDS
"""

_ZSH = """\
_linkwright_complete() {
  local -a found
  found=("${(@f)$(PYTHON -m linkwright.cli.completion "${(@Q)words[1,CURRENT-1]}" "${(Q)PREFIX}" 2>/dev/null)}")
  found=(${found:#})
  (( ${found[(Ie)FILES]} )) && _files
  found=(${found:#FILES})
  compadd -S '' -- ${(M)found:#*=}
  compadd -- ${found:#*=}
}
(( $+functions[compdef] )) || { autoload -Uz compinit && compinit; }
compdef _linkwright_complete COMMANDS
"""

_FISH = """\
function __linkwright_complete
    for each in (PYTHON -m linkwright.cli.completion (commandline -opc) (commandline -ct) 2>/dev/null)
        if test "$each" = FILES
            __fish_complete_path (commandline -ct)
        else
            echo $each
        end
    end
end
for each in COMMANDS
    complete -c $each -f -a '(__linkwright_complete)'
end
"""

SHELLS = {"bash": _BASH, "zsh": _ZSH, "fish": _FISH}

_ROS2_COMPLETION = {
    "bash": 'case "$(command -v ros2)" in "$MARK"/*) complete -F _linkwright_complete ros2 ;; esac\n',
    "zsh": 'case "$(command -v ros2)" in "$MARK"/*) compdef _linkwright_complete ros2 ;; esac\n',
    "fish": "string match -q -- $MARK'/*' (command -s ros2); and complete -c ros2 -f -a '(__linkwright_complete)'\n",
}

_NOT_FOUND = {
    "bash": """\
declare -F command_not_found_handle >/dev/null && eval "_linkwright_other_$(declare -f command_not_found_handle)"
command_not_found_handle() {
  case "$1" in NAMES) PYTHON -m linkwright.shell.instead "$1"; return ;; esac
  if declare -F _linkwright_other_command_not_found_handle >/dev/null; then
    _linkwright_other_command_not_found_handle "$@"
  else
    echo "bash: $1: command not found" >&2
    return 127
  fi
}
""",
    "zsh": """\
(( $+functions[command_not_found_handler] )) && functions[_linkwright_other]=$functions[command_not_found_handler]
command_not_found_handler() {
  case "$1" in NAMES) PYTHON -m linkwright.shell.instead "$1"; return ;; esac
  if (( $+functions[_linkwright_other] )); then
    _linkwright_other "$@"
  else
    echo "zsh: command not found: $1" >&2
    return 127
  fi
}
""",
    "fish": """\
function fish_command_not_found
    if contains -- $argv[1] NAMES
        PYTHON -m linkwright.shell.instead $argv[1]
    else
        __fish_default_command_not_found_handler $argv
    end
end
""",
}
"""The handler for unknown commands in each shell.

It suggests the replacements for commands of ROS.
"""


def completion_script(shell: str, python: str, commands: Sequence[str]) -> str:
    """Return the completion script for a shell.

    Args:
        shell: a key of `SHELLS`.
        python: the interpreter that has Linkwright.
        commands: the commands to complete.
    """
    text = SHELLS[shell].replace("PYTHON", shlex.quote(python)).replace("COMMANDS", " ".join(commands))
    return text.replace("FILES", FILES)


def startup_script(shell: str, python: str, mark: str, missing: Sequence[str]) -> str:
    """Return the start-up script of ``linkwright shell``.

    The script sets up completion, and prints a hint when the user calls a program that is not available.

    Args:
        shell: a key of `SHELLS`.
        python: the interpreter that has Linkwright.
        mark: the environment variable that names the folder of Linkwright's programs.
        missing: the unavailable programs that Linkwright can replace.
    """
    names = (" " if shell == "fish" else "|").join(missing)
    not_found = _NOT_FOUND[shell].replace("PYTHON", shlex.quote(python)).replace("NAMES", names)
    return completion_script(shell, python, ["linkwright"]) + _ROS2_COMPLETION[shell].replace("MARK", mark) + not_found
