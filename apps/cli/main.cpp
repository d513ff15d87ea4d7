// The command line: a thin program over the public headers.
#include "process.h"
#include "run.h"

int main(int argc, char** argv) {
  lumirank::cli::prepare_process();
  return lumirank::cli::run({argv + (argc > 0 ? 1 : 0), argv + argc}, {stdout, stderr});
}
