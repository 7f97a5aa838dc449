// Says where the program that reads OpenVDB files is found.
#include <mote/media/grid_reader_process.h>

#include <cstdio>

int main() { std::puts(mote::media::grid_reader_path().c_str()); }
