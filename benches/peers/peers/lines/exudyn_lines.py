"""Exudyn: a body in the plane at its centre of mass, the blade a constraint on velocities, implicit trapezoidal rule.

The mass matrix is constant and stays inside Exudyn; the constraint (and a force, where there is one) is a Python function,
since Exudyn has no blade of its own and makes no symbolic (compiled) function of either.
"""

import math

import exudyn as exu
import exudyn.itemInterface as item
import numpy as np

from .. import equations
from ..measure import Line

STEPS = [0.2 / 2**k for k in range(14)]


# It warns in every run that functions in Python cost time, which the times say.
exu.config.suppressWarnings = True
exu.SetWriteToConsole(False)


def lines(problem):
    m, inertia, a = problem.mass, problem.inertia, problem.offset
    residual = equations.namespace(problem)["residual"]
    x, y, th, u, w = problem.start
    c, s = math.cos(th), math.sin(th)

    def force(_mbs, _t, _item, q, v):
        # At rest the residual of the equations at the blade is minus their forces; the pole moves to the centre of mass.
        cq, sq = math.cos(q[2]), math.sin(q[2])
        px, py = q[0] - a * cq, q[1] - a * sq
        vx, vy = v[0] + a * v[2] * sq, v[1] - a * v[2] * cq
        r = residual(px, py, q[2], vx, vy, v[2], vx, vy, v[2], 0.0, 0.0, 0.0, 0.0)
        fx, fy = -r[3] - m * a * cq * v[2] ** 2, -r[4] - m * a * sq * v[2] ** 2
        return [fx, fy, -r[5] - a * (fy * cq - fx * sq)]

    def slip(_mbs, _t, _item, q, v, _velocity_level):
        return [v[1] * math.cos(q[2]) - v[0] * math.sin(q[2]) - a * v[2]]

    def slip_jacobian(_mbs, _t, _item, q, _v, _velocity_level):
        return np.array([[-math.sin(q[2]), math.cos(q[2]), -a]])

    def prepare(step):
        container = exu.SystemContainer()
        mbs = container.AddSystem()
        node = mbs.AddNode(item.NodeGenericODE2(
            numberOfODE2Coordinates=3, referenceCoordinates=[0.0] * 3, initialCoordinates=[x + a * c, y + a * s, th],
            initialCoordinates_t=[u * c - a * w * s, u * s + a * w * c, w]))
        # A free sleigh has no force to ask Python for.
        loads = {"forceUserFunction": force} if problem.effects else {}
        mbs.AddObject(item.ObjectGenericODE2(nodeNumbers=[node], massMatrix=np.diag([m, m, inertia]), **loads))
        ground = mbs.AddNode(item.NodePointGround())
        markers = [mbs.AddMarker(item.MarkerNodeCoordinates(nodeNumber=n)) for n in (node, ground)]
        mbs.AddObject(item.ObjectConnectorCoordinateVector(
            markerNumbers=markers, scalingMarker0=np.zeros((1, 3)), scalingMarker1=np.zeros((1, 0)), velocityLevel=True,
            constraintUserFunction=slip, jacobianUserFunction=slip_jacobian))
        mbs.Assemble()
        settings = exu.SimulationSettings()
        steps = math.ceil(problem.duration / step)
        integration = settings.timeIntegration
        integration.numberOfSteps = steps
        integration.endTime = problem.duration
        integration.verboseMode = 0
        integration.newton.relativeTolerance = 1e-12
        integration.newton.absoluteTolerance = 1e-14
        settings.solutionSettings.writeSolutionToFile = False
        settings.displayStatistics = False
        settings.displayComputationTime = False

        def run():
            if not mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2):
                raise ArithmeticError("the solver gave up")
            q = mbs.systemData.GetODE2Coordinates()
            return (q[0] - a * math.cos(q[2]), q[1] - a * math.sin(q[2]), q[2]), steps

        return run

    return [Line("exudyn trapezoidal", "exudyn", "velocity-level constraint", prepare, STEPS, "step")]
