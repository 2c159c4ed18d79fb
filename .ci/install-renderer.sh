#!/usr/bin/env bash
# Puts a software renderer (Vulkan on the processor) and a virtual display on a Debian machine, for the tests that
# draw. Does nothing where both are there. Debian 12's own Mesa is too old (it lacks arrays of textures), so the
# renderer comes from the backports of the suite that the machine already uses, by the machine's own source entry.
set -euo pipefail

needed=(mesa-vulkan-drivers libvulkan1 libdrm2 libdrm-amdgpu1 xvfb xauth x11-xkb-utils
    libx11-6 libx11-xcb1 libxcursor1 libxi6 libxrandr2 libxkbcommon-x11-0)
oldest_mesa=24

version() { dpkg-query --show --showformat '${db:Status-Status} ${Version}' "$1" 2>/dev/null || true; }

installed() {
    local package mesa
    for package in "${needed[@]}"; do
        [[ "$(version "$package")" == "installed "* ]] || return 1
    done
    mesa="$(version mesa-vulkan-drivers)"
    dpkg --compare-versions "${mesa#installed }" ge "$oldest_mesa"
}

# The machine's source entry for suite $1, of either format, with suite $2 in its place; empty where there is none.
entry_for() {
    local file
    for file in /etc/apt/sources.list.d/*.sources; do
        [[ -f "$file" ]] || continue
        awk -v suite="$1" -v wanted="$2" 'BEGIN { RS = ""; FS = "\n" } {
            found = 0
            for (i = 1; i <= NF; i++) if ($i ~ /^Suites:/) {
                n = split($i, words, /[ \t]+/)
                for (j = 2; j <= n; j++) if (words[j] == suite) found = 1
            }
            if (!found) next
            for (i = 1; i <= NF; i++) if ($i !~ /^#/) print ($i ~ /^Suites:/ ? "Suites: " wanted : $i)
            exit
        }' "$file"
    done
}

line_for() {
    local file
    for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
        [[ -f "$file" ]] || continue
        awk -v suite="$1" -v wanted="$2" '$1 == "deb" {
            for (i = 2; i <= NF; i++) if ($i == suite) { $i = wanted; print; exit }
        }' "$file"
    done | head -n 1
}

add_backports() {
    local suite="$1" list=/etc/apt/sources.list.d entry
    grep -rqs -- "$suite-backports" /etc/apt/sources.list "$list" && return 0
    entry="$(entry_for "$suite" "$suite-backports")"
    if [[ -n "$entry" ]]; then
        printf '%s\n' "$entry" >"$list/$suite-backports.sources"
        return 0
    fi
    entry="$(line_for "$suite" "$suite-backports")"
    [[ -n "$entry" ]] || return 1
    printf '%s\n' "$entry" >"$list/$suite-backports.list"
}

main() {
    if installed; then
        echo "the software renderer is installed"
        return 0
    fi
    if [[ "$(id -u)" != 0 ]] || ! command -v apt-get >/dev/null; then
        echo "the software renderer needs root on a Debian machine; install by hand: ${needed[*]}" >&2
        return 1
    fi
    export DEBIAN_FRONTEND=noninteractive
    local suite from=()
    suite="$(. /etc/os-release && echo "${VERSION_CODENAME:-}")"
    # Later Debians have a Mesa that is new enough in their own suite.
    if [[ "$suite" == bookworm ]]; then
        add_backports "$suite" || { echo "no apt source names the suite $suite; add its backports" >&2; return 1; }
        from=(--target-release "$suite-backports")
    fi
    # A source of something else that does not answer must not stop this; what is missing then, the next line says.
    apt-get update -qq || true
    apt-get install -qq --yes --no-install-recommends "${from[@]}" "${needed[@]}" >/dev/null
    installed || { echo "apt installed a Mesa older than $oldest_mesa; see that backports are reachable" >&2; return 1; }
    echo "the software renderer is installed: Mesa $(version mesa-vulkan-drivers | cut -d' ' -f2)"
}

main "$@"
