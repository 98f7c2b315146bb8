// Memory that OpenGL drivers keep for themselves when a context is destroyed. LeakSanitizer asks for this
// list in builds with LIMN_SANITIZE; in others nothing calls it.
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the name is LeakSanitizer's

extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa.so\nleak:_dri.so\nleak:libEGL\nleak:libGLX\nleak:libX11\n";
}
