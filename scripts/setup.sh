#!/bin/sh
# Installs what building and testing need and what this machine lacks. Debian 12
# package names. Says what it installs; does nothing when all is there.
# usage: setup.sh [--build] [PACKAGE...]; --build: no more than building the tools takes.
set -eu

missing=""
need() {  # need COMMAND PACKAGE
  command -v "$1" >/dev/null 2>&1 || missing="$missing $2"
}
need g++ g++
need cmake cmake
need ninja ninja-build
if [ "${1:-}" = --build ]; then
  shift
else
  need ccache ccache
  need python3 python3
  [ -e /usr/include/gtest/gtest.h ] || missing="$missing libgtest-dev"
  [ -e /usr/include/modbus/modbus.h ] || missing="$missing libmodbus-dev"
  need mbpoll mbpoll
  need curl curl
  need xmllint libxml2-utils
  need zsh zsh
  need fish fish
  [ -e /usr/include/pugixml.hpp ] || missing="$missing libpugixml-dev"
  [ -e /usr/include/openssl/evp.h ] || missing="$missing libssl-dev"
  [ -e /usr/include/mosquitto.h ] || missing="$missing libmosquitto-dev"
  [ -x /usr/sbin/mosquitto ] || need mosquitto mosquitto
fi
for package in "$@"; do  # extra packages of one make target
  dpkg -s "$package" >/dev/null 2>&1 || missing="$missing $package"
done
[ -z "$missing" ] && exit 0

echo "setup: installing$missing (apt-get)"
sudo=""
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null 2>&1 || {
    echo "setup: not root and no sudo; as root run: apt-get install$missing" >&2
    exit 1
  }
  sudo=sudo
fi
export DEBIAN_FRONTEND=noninteractive
$sudo apt-get update -qq
# shellcheck disable=SC2086
$sudo apt-get install -y -qq --no-install-recommends $missing >/dev/null
