# Read by ctest before the tests. Software renderers allocate and clear the textures of every picture, which takes a fraction of
# the time in huge pages, where the kernel grants them to those who ask, and less again where what was freed is used again
# instead of being given back and cleared by the kernel.
if(NOT DEFINED ENV{GLIBC_TUNABLES})
  set(ENV{GLIBC_TUNABLES} glibc.malloc.hugetlb=1:glibc.malloc.mmap_max=0:glibc.malloc.trim_threshold=17179869184)
endif()
