# Read by ctest before the tests. Software renderers allocate and clear the textures of every picture, which takes a fraction of
# the time in huge pages, where the kernel grants them to those who ask.
if(NOT DEFINED ENV{GLIBC_TUNABLES})
  set(ENV{GLIBC_TUNABLES} glibc.malloc.hugetlb=1)
endif()
