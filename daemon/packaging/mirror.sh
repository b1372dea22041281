# Where this machine gets Debian from. Sourced by the scripts.

debian_release() {
  . /etc/os-release
  echo "$VERSION_CODENAME"
}

# Lines of a sources.list: the machine's sources of Debian, without those of others.
debian_sources() {
  list_sources() {
    # shellcheck disable=SC2016  # apt's words
    apt-get indextargets --format '$(ORIGIN) deb $(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
      sed -n 's/^Debian //p' | sort -u
  }
  sources=$(list_sources)
  if [ -z "$sources" ]; then
    as_root=
    [ "$(id -u)" -eq 0 ] || as_root="sudo -n"
    $as_root apt-get update -q >/dev/null
    sources=$(list_sources)
  fi
  printf '%s\n' "$sources"
}
