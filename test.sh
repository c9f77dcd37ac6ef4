#!/usr/bin/env bash
# Runs all tests.
#
# The tests of the GPU parts need a graphics adapter, hardware or software. Where no Vulkan driver is found, Mesa's
# software driver (lavapipe) is installed on Debian and Ubuntu, and Mesa's EGL, for OpenGL, with it; elsewhere this script
# says what to install, and the tests that need an adapter are skipped.
#
# NPR_GPU=auto      (default) use an adapter if there is one, else skip what needs one
# NPR_GPU=required  no adapter is a failure
# NPR_GPU=off       look for none, install nothing
set -eu
cd "$(dirname "$0")"
export NPR_GPU="${NPR_GPU:-auto}"

say() { printf 'test.sh: %s\n' "$*"; }

case "$NPR_GPU" in
auto | required | off) ;;
*)
    say "NPR_GPU is \"$NPR_GPU\"; it must be auto, required or off" >&2
    exit 1
    ;;
esac

# Mesa asks for this folder and complains where there is none.
if [ -z "${XDG_RUNTIME_DIR:-}" ]; then
    XDG_RUNTIME_DIR="$(mktemp -d)"
    export XDG_RUNTIME_DIR
    trap 'rm -rf "$XDG_RUNTIME_DIR"' EXIT
fi

# has_library NAME: whether the loader finds it.
has_library() {
    for ldconfig in ldconfig /sbin/ldconfig /usr/sbin/ldconfig; do
        if command -v "$ldconfig" >/dev/null 2>&1; then
            # No pipe into grep -q: it would end ldconfig early.
            case "$("$ldconfig" -p 2>/dev/null || true)" in *"$1"*) return 0 ;; esac
        fi
    done
    local folders="${LD_LIBRARY_PATH:-}:/usr/lib:/usr/lib64:/usr/local/lib" folder
    local IFS=:
    for folder in $folders; do
        if [ -n "$folder" ] && [ -e "$folder/$1" ]; then return 0; fi
    done
    return 1
}

# EGL and Mesa's implementation of it, which has a software rasteriser.
has_egl() {
    has_library libEGL.so.1 && has_library libEGL_mesa.so.0
}

# The manifests of the drivers that the Vulkan loader would find, one a line.
drivers() {
    local IFS=: folder file
    local chosen="${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}}"
    if [ -n "$chosen" ]; then
        for file in $chosen; do
            if [ -f "$file" ]; then printf '%s\n' "$file"; fi
        done
        return 0
    fi
    for folder in "${XDG_CONFIG_HOME:-${HOME:-}/.config}" ${XDG_CONFIG_DIRS:-/etc/xdg} /etc \
        "${XDG_DATA_HOME:-${HOME:-}/.local/share}" ${XDG_DATA_DIRS:-/usr/local/share:/usr/share} /usr/share; do
        for file in "$folder"/vulkan/icd.d/*.json; do
            if [ -f "$file" ]; then printf '%s\n' "$file"; fi
        done
    done
}

has_device() {
    local node
    for node in /dev/dri/renderD* /dev/nvidia[0-9]* /dev/dxg; do
        if [ -e "$node" ]; then return 0; fi
    done
    return 1
}

# A loader, and a software driver or the driver of a device; a hardware driver without a device is of no use.
has_vulkan() {
    has_library libvulkan.so.1 || return 1
    local found
    found="$(drivers)"
    case "$found" in
    *lvp_icd* | *lavapipe* | *swiftshader*) return 0 ;;
    '') return 1 ;;
    *) has_device ;;
    esac
}

# install PACKAGES
install() {
    local as_root=() packages=("$@")
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null 2>&1; then
            say "not root and no sudo; as root: apt-get install ${packages[*]}"
            return 1
        fi
        as_root=(sudo)
        # Ask for a password only where somebody can answer.
        if [ ! -t 0 ]; then as_root+=(-n); fi
    fi
    as_root+=(env DEBIAN_FRONTEND=noninteractive)
    say "installing Mesa's software drivers: ${as_root[*]} apt-get install -y --no-install-recommends ${packages[*]}"
    "${as_root[@]}" apt-get update -qq || say "apt-get update failed; going on with the lists there are"
    "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${packages[@]}"
}

# Whether tests that need an adapter will find none, as far as can be told from here.
without_adapter=no

prepare_adapter() {
    if [ "$NPR_GPU" = off ]; then
        say "NPR_GPU=off: no adapter is looked for"
        without_adapter=yes
        return
    fi
    case "$(uname -s)" in
    Linux) ;;
    *)
        say "$(uname -s): using the system's own graphics interface"
        return
        ;;
    esac
    if ! has_egl && command -v apt-get >/dev/null 2>&1; then
        install libegl1 libegl-mesa0 libgl1-mesa-dri || say "going on without OpenGL"
    fi
    if [ "${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}}" ] && ! has_vulkan && has_egl; then
        say "VK_DRIVER_FILES or VK_ICD_FILENAMES hides Vulkan: the tests use OpenGL"
        return
    fi
    if has_vulkan; then
        say "a Vulkan driver is there: nothing to install"
        return
    fi
    say "no usable Vulkan driver found"
    if [ -n "${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}}" ]; then
        say "VK_DRIVER_FILES or VK_ICD_FILENAMES chooses the drivers, so installing one would change nothing"
    elif command -v apt-get >/dev/null 2>&1; then
        if install mesa-vulkan-drivers libvulkan1 && has_vulkan; then
            say "installed"
            return
        fi
        say "the driver could not be installed"
    else
        say "install a Vulkan driver; Mesa's lavapipe needs no graphics card:"
        say "  Fedora: dnf install mesa-vulkan-drivers; Arch: pacman -S vulkan-swrast vulkan-icd-loader;"
        say "  Alpine: apk add mesa-vulkan-swrast vulkan-loader; openSUSE: zypper install libvulkan_lvp libvulkan1"
    fi
    say "going on without, NPR_GPU=$NPR_GPU"
    without_adapter=yes
}

run() {
    say "$*"
    "$@"
}

prepare_adapter
run cargo test --workspace --features npr-hatch/wgpu,npr-outline/wgpu,npr-imagespace/wgpu
# Each crate alone, as someone gets it who wants no more than that.
for crate in npr-mesh npr-outline npr-toon npr-gooch npr-hatch npr-imagespace npr-harness; do
    run cargo check -p "$crate" --no-default-features
done
if [ "$without_adapter" = yes ]; then
    say "passed; no driver was found or wanted, so tests that need an adapter may have been skipped"
else
    say "passed"
fi
