/* A parallel loop for each of OpenMP's schedules. */

#include <stddef.h>

/* One iteration. Called from several threads at once; must not unwind. */
typedef void iteration(const void *context, size_t index);

/* Starts the threads; how many there are then, the caller's among them. */
int rayweave_openmp_start(int threads);

/* Calls `compute` for each index below `count`. */
void rayweave_openmp_static(int threads, size_t count, iteration *compute, const void *context);
void rayweave_openmp_dynamic(int threads, size_t count, iteration *compute, const void *context);
void rayweave_openmp_guided(int threads, size_t count, iteration *compute, const void *context);

/* Ends the threads. */
void rayweave_openmp_end(void);
