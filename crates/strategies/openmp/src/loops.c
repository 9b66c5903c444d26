#include "loops.h"

#include <omp.h>

int rayweave_openmp_start(int threads)
{
    int team = 0;
    /* As many as are asked for, however busy the machine is and whatever OMP_DYNAMIC says. */
    omp_set_dynamic(0);
#pragma omp parallel num_threads(threads)
    {
#pragma omp master
        team = omp_get_num_threads();
    }
    return team;
}

void rayweave_openmp_static(int threads, size_t count, iteration *compute, const void *context)
{
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t index = 0; index < count; index++)
        compute(context, index);
}

void rayweave_openmp_dynamic(int threads, size_t count, iteration *compute, const void *context)
{
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
    for (size_t index = 0; index < count; index++)
        compute(context, index);
}

void rayweave_openmp_guided(int threads, size_t count, iteration *compute, const void *context)
{
#pragma omp parallel for num_threads(threads) schedule(guided, 1)
    for (size_t index = 0; index < count; index++)
        compute(context, index);
}

void rayweave_openmp_end(void)
{
    omp_pause_resource_all(omp_pause_soft);
}
