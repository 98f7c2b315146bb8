// Running sums over threads of a work group. Define LENGTH, the threads that follow a line, and LINES, the lines that the group
// follows at once; LOCAL_LINE and LOCAL_POSITION, where the thread is; SUM_TYPE, a vector of integers; and SUM(a, b), which must be
// the same in any order.
#ifndef LIMN_GROUP_SCAN_GLSL
#define LIMN_GROUP_SCAN_GLSL

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

#endif  // LIMN_GROUP_SCAN_GLSL
