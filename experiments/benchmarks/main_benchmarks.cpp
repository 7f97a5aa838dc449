// The program of all benchmarks; `run` in this folder calls it and prints the table of ratios.
#include <benchmark/benchmark.h>

BENCHMARK_MAIN();
