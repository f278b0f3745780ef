#pragma once
// The commands of the program: one file each.

namespace CLI {
class App;
}

namespace breccia {
class Communicator;
}

namespace breccia::app {

/// Each adds one command; when it is called it does its work and sets the exit code of the program.
/// Errors leave as the classes of exec/error.hpp. `ranks` are those that share a run; null: none.
void add_run(CLI::App& program, int& exit_code, Communicator* ranks);
void add_resume(CLI::App& program, int& exit_code, Communicator* ranks);
void add_prepare(CLI::App& program);
void add_check(CLI::App& program, int& exit_code);
void add_keys(CLI::App& program);
void add_materials(CLI::App& program);
void add_explain(CLI::App& program);
void add_new(CLI::App& program);
void add_demo(CLI::App& program, int& exit_code);
void add_doctor(CLI::App& program);
void add_info(CLI::App& program);
void add_compare(CLI::App& program);
void add_mesh(CLI::App& program);
void add_convert(CLI::App& program);
void add_render(CLI::App& program);
void add_report(CLI::App& program);
void add_sweep(CLI::App& program, int& exit_code);
void add_test(CLI::App& program, int& exit_code);
void add_watch(CLI::App& program, int& exit_code);
void add_verify(CLI::App& program, int& exit_code);
void add_shell_file(CLI::App& program);
void add_calibrate(CLI::App& program, int& exit_code);
void add_bench(CLI::App& program, Communicator* ranks);  ///< bench/command.cpp

}  // namespace breccia::app
