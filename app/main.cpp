// The program: everything is in the commands.
#include <iostream>
#include <string>
#include <vector>

#include "app/commands/command_line.h"

int main(int count, char** arguments) {
  return app::run_command(std::vector<std::string>(arguments + 1, arguments + count), std::cout,
                          std::cerr);
}
