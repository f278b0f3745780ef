# Sourced: programs of build/release with some of their objects and libraries replaced.

# relink TARGET TO WORDS...: the linking of TARGET, with each WORD "old=new", to the file TO; paths from the repository.
relink() {
  local link target=$1 to=$2
  link=$(ninja -C build/release -t commands "$target" | tail -1)
  link=${link%% && cd *}
  link=${link/" -o "+([^ ])/" -o $PWD/$to"}
  shift 2
  for word in "$@"; do link=${link//"${word%%=*}"/"${word#*=}"}; done
  (cd build/release && bash -c "$link")
}
shopt -s extglob
