// What `convert` does to a mesh on its way.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "easypbr/cli/command.h"
#include "easypbr/cli/phases.h"
#include "easypbr/scene/mesh.h"

namespace easypbr::cli {

/// One thing to do, with the option that asked for it.
struct MeshStep {
    std::string option;
    std::function<void()> check;  ///< throws ArgumentError for numbers that no mesh makes right
    std::function<Mesh(const Mesh&)> apply;
};

/// Adds the options; each that is given appends a step, in the order of the command line.
void declare_mesh_steps(CLI::App& command, std::vector<MeshStep>& steps);

/// Throws ArgumentError for what the options alone show.
void check_mesh_steps(const std::vector<MeshStep>& steps);

/// The mesh after all steps. When there are any, its children are made part of it first. Each begins a phase.
Mesh apply_mesh_steps(const Mesh& mesh, const std::vector<MeshStep>& steps, Phases& phases);

}  // namespace easypbr::cli
