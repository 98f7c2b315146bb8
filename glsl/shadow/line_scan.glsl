// Running sums along the lines of a map, its rows (VERTICAL 0) or its columns (VERTICAL 1). SHARED 0: a thread follows a whole
// line (quickest where threads are few, on software renderers). SHARED 1: LENGTH threads of a work group follow a line, LINES
// lines at a time, and scan_line() adds up what each of them has. How many lines a group takes is known to lineGroups() in
// core/shadow/summed_area_passes.cpp, too.
//
// Define SUM_TYPE, a vector of integers, and SUM(a, b), which must be the same in any order.
#ifndef LIMN_LINE_SCAN_GLSL
#define LIMN_LINE_SCAN_GLSL

#if SHARED
#if VERTICAL
#define LINES 16  // neighbouring columns, so that neighbouring threads meet neighbouring texels
#define LENGTH 16
layout(local_size_x = LINES, local_size_y = LENGTH) in;
#define LOCAL_LINE int(gl_LocalInvocationID.x)
#define LOCAL_POSITION int(gl_LocalInvocationID.y)
#else
#define LINES 4
#define LENGTH 64
layout(local_size_x = LENGTH, local_size_y = LINES) in;
#define LOCAL_LINE int(gl_LocalInvocationID.y)
#define LOCAL_POSITION int(gl_LocalInvocationID.x)
#endif

shared SUM_TYPE partial_sums[2][LINES][LENGTH];

// The sum of what the threads before this one have in its line; all: of what all threads of the line have. Every thread of the
// group must call. Hillis and Steele 1986, Data parallel algorithms: the reach of every sum doubles with each step.
SUM_TYPE scan_line(SUM_TYPE own, out SUM_TYPE all) {
  SUM_TYPE sum = own;
  int side = 0;
  partial_sums[side][LOCAL_LINE][LOCAL_POSITION] = sum;
  barrier();
  for (int reach = 1; reach < LENGTH; reach *= 2) {
    if (LOCAL_POSITION >= reach) sum = SUM(sum, partial_sums[side][LOCAL_LINE][LOCAL_POSITION - reach]);
    side = 1 - side;
    partial_sums[side][LOCAL_LINE][LOCAL_POSITION] = sum;
    barrier();
  }
  SUM_TYPE before = SUM_TYPE(0);
  if (LOCAL_POSITION > 0) before = partial_sums[side][LOCAL_LINE][LOCAL_POSITION - 1];
  all = partial_sums[side][LOCAL_LINE][LENGTH - 1];
  barrier();
  return before;
}
#else
layout(local_size_x = 16) in;
#endif

#endif  // LIMN_LINE_SCAN_GLSL
