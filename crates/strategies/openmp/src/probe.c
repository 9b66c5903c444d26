/* A program around the loops, to see whether they can be linked. It is never run. */

#include "loops.h"

int main(void)
{
    rayweave_openmp_end();
    return rayweave_openmp_start(1) != 1;
}
