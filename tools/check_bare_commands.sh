#!/bin/bash
# On a Debian 12 and a Debian 13 that have nothing: do ./quickstart and ./test run as in README.md?
#
#   tools/check_bare_commands.sh [--keep] [RELEASE...]     RELEASE: bookworm, trixie; default: both
#
# Makes a Debian of the smallest kind in build/bare_RELEASE (debootstrap) with git, clones the last commit of this checkout
# there and runs both commands, which install what they need themselves. Prints the last lines of each; the whole is in
# build/bare_RELEASE.log. --keep: takes a Debian that is there with its packages, build and cache of the compiler, instead
# of a bare one. Real files by others are taken from MOTE_TEST_DATA (default ../shared/data) where they are there. Needs
# root, debootstrap, Debian's packages (1.5 GB each) and PyPI; an hour and a half on two cores; not part of ./test.
set -euo pipefail
source=$(cd "$(dirname "$0")/.." && pwd)
keep=0 releases=()
for argument in "$@"; do
  case $argument in
    --keep) keep=1 ;;
    bookworm | trixie) releases+=("$argument") ;;
    *) sed -n '2,4s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
  esac
done
((${#releases[@]})) || releases=(bookworm trixie)
if ((EUID != 0)) || ! command -v debootstrap > /dev/null; then
  echo "error: needs root, and debootstrap (apt-get install debootstrap)" >&2
  exit 1
fi
data=${MOTE_TEST_DATA:-$(dirname "$source")/shared/data}

root=
inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 HOME=/root DEBIAN_FRONTEND=noninteractive \
    ${PIP_CERT:+PIP_CERT=/srv/certificates.crt} "$@"
}
unmount() {
  local folder
  for folder in proc dev root/shared/data; do
    mountpoint -q "$root/$folder" && umount "$root/$folder"
  done
  return 0
}
trap unmount EXIT

# A Debian of this release in $root, with the checkout in /srv/mote.
prepare() {
  local release=$1
  ((keep)) && [[ -e $root/etc/debian_version ]] || { rm -rf --one-file-system "$root" && debootstrap --variant=minbase "$release" "$root"; }
  mkdir -p "$root/root/shared/data"
  mount -t proc proc "$root/proc"
  mount --bind /dev "$root/dev"
  [[ ! -d $data ]] || mount --bind -o ro "$data" "$root/root/shared/data"
  [[ -z ${PIP_CERT:-} ]] || cp -L "$PIP_CERT" "$root/srv/certificates.crt"
  inside apt-get update -q
  inside apt-get install -y -q --no-install-recommends git ca-certificates
  [[ -d $root/srv/mote/.git ]] || git clone -q "file://$source" "$root/srv/mote"
  git -C "$root/srv/mote" fetch -q "file://$source" "$(git -C "$source" rev-parse HEAD)"
  git -C "$root/srv/mote" checkout -q --detach FETCH_HEAD
}

failed=0
mkdir -p "$source/build"
for release in "${releases[@]}"; do
  root=$source/build/bare_$release log=$source/build/bare_$release.log
  echo "== a bare $release"
  unmount
  prepare "$release" > "$log" 2>&1 || { tail -n 20 "$log" && exit 1; }
  for command in ./quickstart ./test; do
    begin=$SECONDS
    if inside sh -c "cd /srv/mote && $command" > "$log.part" 2>&1; then said=passes; else said=FAILS failed=1; fi
    tail -n 12 "$log.part"
    echo "== $release: $command $said, $((SECONDS - begin)) s: $log"
    cat "$log.part" >> "$log"
  done
  rm -f "$log.part"
  unmount
done
exit $failed
