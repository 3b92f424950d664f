#!/bin/sh
# Install Linkwright from this folder, without a network and without administrator's rights: sh install.sh [FOLDER]
# It needs a Python of @PYTHONS@, or an archive of one in the folder 'python'.

here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
unpacked="$HOME/linkwright-python"

fits() {
    [ -n "$(command -v "$1" 2>/dev/null)" ] || return 1
    # On a Mac without developer tools, /usr/bin/python3 only opens a dialog.
    if [ "$(command -v "$1")" = /usr/bin/python3 ] && [ "$(uname -s)" = Darwin ]; then
        xcode-select -p >/dev/null 2>&1 || return 1
    fi
    "$1" -c 'import sys; sys.exit("%d.%d" % sys.version_info[:2] not in "@PYTHONS@".split())' >/dev/null 2>&1
}

find_python() {
    for version in @PYTHONS@; do
        for candidate in "python$version" \
            "/opt/homebrew/bin/python$version" "/usr/local/bin/python$version" "$HOME/.local/bin/python$version" \
            "/Library/Frameworks/Python.framework/Versions/$version/bin/python3" \
            "$HOME/.pyenv/versions/$version".*/bin/python3; do
            if fits "$candidate"; then echo "$candidate"; return; fi
        done
    done
    for candidate in python3 python "$unpacked/python/bin/python3"; do
        if fits "$candidate"; then echo "$candidate"; return; fi
    done
}

unpack_python() {
    case "$(uname -s)-$(uname -m)" in
        Linux-x86_64) triple=x86_64-unknown-linux-gnu ;;
        Linux-aarch64) triple=aarch64-unknown-linux-gnu ;;
        Darwin-arm64) triple=aarch64-apple-darwin ;;
        Darwin-x86_64) triple=x86_64-apple-darwin ;;
        *) return ;;
    esac
    for archive in "$here/python/"*"$triple"-install_only*.tar.gz; do
        [ -f "$archive" ] || continue
        mkdir -p "$unpacked" && tar -xzf "$archive" -C "$unpacked" && return
    done
}

python=${PYTHON:-$(find_python)}
if [ -z "$python" ]; then
    unpack_python
    python=$(find_python)
fi
if [ -z "$python" ]; then
    cat "$here/no-python.txt" >&2
    exit 1
fi
exec "$python" "$here/install.py" "$@"
