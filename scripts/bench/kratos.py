"""Peer: Kratos Multiphysics. Elements SmallDisplacementElement2D4N and 2D3N, consistent mass, Newmark's method, joints
Geo_ULineInterfacePlaneStrainElement2Plus2N with Coulomb's law and tension cut-off.
"""

import math
import time
from importlib import metadata

import KratosMultiphysics as kratos
import KratosMultiphysics.GeoMechanicsApplication  # noqa: F401 elements, laws and variables register themselves
import KratosMultiphysics.LinearSolversApplication  # noqa: F401 so do its solvers
import KratosMultiphysics.StructuralMechanicsApplication as structure
import numpy as np
from KratosMultiphysics import python_linear_solver_factory

from .job import arguments, leave, model_of
from .scipy_bonded import Newmark

STATE = (kratos.DISPLACEMENT, kratos.VELOCITY, kratos.ACCELERATION, kratos.REACTION, kratos.WATER_PRESSURE,
         structure.POINT_LOAD)


def build(model, part):
    """Nodes, elements, joints and loaded points; numbers count from 1."""
    for n, (x, y) in enumerate(model.points):
        node = part.CreateNewNode(n + 1, float(x), float(y), 0.0)
        for axis in ("X", "Y", "Z"):  # Kratos asks for all three, its plane elements use two
            node.AddDof(*(kratos.KratosGlobals.GetVariable(f"{name}_{axis}") for name in ("DISPLACEMENT", "REACTION")))
        node.AddDof(kratos.WATER_PRESSURE)  # the joint element asks for it, and there is none
        node.Fix(kratos.WATER_PRESSURE)
    held = np.ones(2 * len(model.points), bool)
    held[model.free] = False
    for dof in np.flatnonzero(held):
        part.Nodes[int(dof) // 2 + 1].Fix((kratos.DISPLACEMENT_X, kratos.DISPLACEMENT_Y)[dof % 2])
    tag = 0
    for number, (group, cells) in enumerate(model.faces(), 1):
        properties = ground(model, part, number, group)
        for nodes in cells:
            tag += 1
            part.CreateNewElement(f"SmallDisplacementElement2D{len(nodes)}N", tag, numbers(model, nodes), properties)
    for ends in joints(model):
        tag += 1
        part.CreateNewElement("Geo_ULineInterfacePlaneStrainElement2Plus2N", tag, [n + 1 for n in ends],
                              interface(model, part))
    loaded = np.flatnonzero(model.load.reshape(-1, 2).any(1))
    for i, n in enumerate(loaded, 1):
        part.CreateNewCondition("PointLoadCondition2D1N", i, [int(n) + 1], part.GetProperties()[0])
    return [int(n) for n in loaded]


def numbers(model, nodes):
    """Anticlockwise, from 1."""
    x, y = model.points[nodes].T
    turned = nodes if x @ np.roll(y, -1) > y @ np.roll(x, -1) else nodes[::-1]
    return [int(n) + 1 for n in turned]


def ground(model, part, number, group):
    properties, material = part.GetProperties()[number], model.case["materials"][group]
    lam, shear = model.lame(group)
    properties.SetValue(kratos.YOUNG_MODULUS, shear * (3 * lam + 2 * shear) / (lam + shear))
    properties.SetValue(kratos.POISSON_RATIO, material["poisson"])
    properties.SetValue(kratos.DENSITY, model.density(group))
    properties.SetValue(kratos.THICKNESS, 1.0)
    properties.SetValue(structure.RAYLEIGH_ALPHA, model.alpha)
    properties.SetValue(structure.RAYLEIGH_BETA, model.beta)
    law = kratos.KratosGlobals.Kernel.GetConstitutiveLaw("LinearElasticPlaneStrain2DLaw")
    properties.SetValue(kratos.CONSTITUTIVE_LAW, law.Clone())
    return properties


def interface(model, part):
    properties = part.GetProperties()[1000]
    if not properties.Has(kratos.CONSTITUTIVE_LAW):
        kn, ks, friction = model.joint_law(model.pairs[0])
        # With atan its results are nearest to those of a friction sin(atan f): its sin(phi) acts as f.
        values = {"INTERFACE_NORMAL_STIFFNESS": kn, "INTERFACE_SHEAR_STIFFNESS": ks, "GEO_COHESION": 0.0,
                  "GEO_FRICTION_ANGLE": math.degrees(math.asin(friction)), "GEO_DILATANCY_ANGLE": 0.0,
                  "GEO_TENSILE_STRENGTH": 0.0}
        for name, value in values.items():
            properties.SetValue(kratos.KratosGlobals.GetVariable(name), value)
        law = kratos.KratosGlobals.Kernel.GetConstitutiveLaw("GeoInterfaceCoulombWithTensionCutOff")
        properties.SetValue(kratos.CONSTITUTIVE_LAW, law.Clone())
    return properties


def joints(model):
    """Two nodes of the body, then the two of the ground, which must lie on the left of each edge of the interfaces."""
    pairs = {pair.ground: pair for pair in model.pairs}
    for name in model.case["interfaces"] if pairs else []:
        for a, b in model.groups[name]["line"]:
            (x, y), normal = model.points[b] - model.points[a], pairs[int(a)].normal
            a, b = (int(n) for n in ((a, b) if normal @ (-y, x) > 0 else (b, a)))
            yield pairs[a].body, pairs[b].body, a, b


def strategy(part, bonded):
    solver = python_linear_solver_factory.ConstructSolver(
        kratos.Parameters('{"solver_type": "LinearSolversApplication.sparse_lu"}'))
    scheme = kratos.ResidualBasedNewmarkDisplacementScheme()
    builder = kratos.ResidualBasedEliminationBuilderAndSolver(solver)  # leaves out what is fixed
    if bonded:
        made = kratos.ResidualBasedLinearStrategy(part, scheme, builder, False, False, False, False)
        made.SetRebuildLevel(0)  # one matrix for all steps
    else:
        test = kratos.DisplacementCriteria(1e-8, 1e-12)
        made = kratos.ResidualBasedNewtonRaphsonStrategy(part, scheme, test, builder, 50, False, False, False)
    made.SetEchoLevel(0)
    made.Initialize()
    made.Check()
    return made


def main():
    a = arguments()
    kratos.Logger.GetDefaultOutput().SetSeverity(kratos.Logger.Severity.WARNING)
    model = model_of(a)
    part = kratos.Model().CreateModelPart("ground")
    part.SetBufferSize(2)
    part.ProcessInfo[kratos.DOMAIN_SIZE] = 2
    for variable in STATE:
        part.AddNodalSolutionStepVariable(variable)
    loaded = build(model, part)
    solution = strategy(part, a.bonded)
    start_accelerations(model, part)
    probes = [part.Nodes[n + 1] for n in model.probes]
    history = np.zeros((a.steps + 1, 2 * len(probes)))
    start = time.perf_counter()
    for n in range(1, a.steps + 1):
        part.ProcessInfo[kratos.STEP] = n
        part.CloneTimeStep(n * a.dt)
        for node in loaded:
            fx, fy = map(float, model.load[2 * node:2 * node + 2] * model.pulse(n * a.dt))
            part.Nodes[node + 1].SetSolutionStepValue(structure.POINT_LOAD, [fx, fy, 0.0])
        solution.InitializeSolutionStep()
        solution.Predict()
        if not solution.SolveSolutionStep():
            raise SystemExit(f"Kratos does not converge in step {n}")
        solution.FinalizeSolutionStep()
        history[n] = [u for node in probes for u in list(node.GetSolutionStepValue(kratos.DISPLACEMENT))[:2]]
    seconds = time.perf_counter() - start
    leave(a, history, seconds, f"Kratos {metadata.version('KratosMultiphysics')}", unknowns=len(model.free))


def start_accelerations(model, part):
    """M a = f(0): the pressure jumps at t = 0."""
    a = np.zeros(2 * len(model.points))
    a[model.free] = Newmark(model, lumped=False).a
    for node in part.Nodes:
        node.SetSolutionStepValue(kratos.ACCELERATION, [*map(float, a[2 * node.Id - 2:2 * node.Id]), 0.0])


if __name__ == "__main__":
    main()
