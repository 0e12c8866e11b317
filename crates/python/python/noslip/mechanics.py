"""The pieces of a system from the methods of `sympy.physics.mechanics`."""

from __future__ import annotations

from collections.abc import Iterable
from random import Random
from typing import Any

from ._noslip import RequestError


def of_lagranges(method: Any) -> dict[str, Any]:
    """Those of a `LagrangesMethod`: its Lagrangian, forces and constraints."""
    method.form_lagranges_equations()
    positions, rows = list(method._hol_coneqs or ()), list(method.coneqs or ())
    return {
        "coordinates": list(method.q),
        "lagrangian": method._L,
        "constraints": rows[len(positions) :],
        "positions": positions,
        "forces": {q: force for q, force in zip(method.q, method._term4, strict=True) if force != 0},
    }


class Kanes:
    """Those of a `KanesMethod`: the kinetic energy of its bodies, its loads as forces, and its constraints.

    Potential energies of bodies count as little as in Kane's equations: gravity is among the loads.
    """

    def __init__(self, method: Any) -> None:
        import sympy as sp
        from sympy.physics.mechanics import ReferenceFrame, dynamicsymbols

        if method._uaux:
            raise RequestError("auxiliary speeds have no place in a system")
        self.frame = method._inertial
        self.coordinates, self.u = list(method.q), list(method.u)
        self.rates = [q.diff(dynamicsymbols._t) for q in self.coordinates]
        # The rates as functions of the speeds, affine in them, and the other way round.
        self.of_speeds = method.kindiffdict()
        right = sp.Matrix([self.of_speeds[rate] for rate in self.rates])
        self.map = right.jacobian(self.u)
        rest = right.xreplace(dict.fromkeys(self.u, sp.Integer(0)))
        self.of_rates = dict(zip(self.u, self.map.LUsolve(sp.Matrix(self.rates) - rest), strict=True))

        loads = [(place, vector) for place, vector in method.forcelist or ()]
        points = [body.masscenter if hasattr(body, "masscenter") else body.point for body in method.bodies]
        self._refuse_reduced([*points, *(place for place, _ in loads if not isinstance(place, ReferenceFrame))])
        self.lagrangian = self.in_rates(sum(body.kinetic_energy(self.frame) for body in method.bodies))
        self.forces = self._forces(loads)
        rows = list(method._k_nh * sp.Matrix(self.u) + method._f_nh) if method._k_nh else []
        self.positions = list(method._f_h) if len(rows) == len(method._f_h) else []
        # The rates of constraints on positions are among the rows; where all are, the positions say it all.
        self.constraints = [] if self.positions else [self.in_rates(row) for row in rows]

    def in_rates(self, expression: Any) -> Any:
        """An expression of speeds as one of rates."""
        import sympy as sp

        return sp.sympify(expression).xreplace(self.of_speeds).xreplace(self.of_rates)

    def _refuse_reduced(self, points: Iterable[Any]) -> None:
        """Refuses velocities that are not those of places in the coordinates: constraints have been put into them.

        Kane's equations may have such velocities. A Lagrangian with them would give the motion of another system.
        """
        for point in points:
            velocity = self.in_rates(point.vel(self.frame).to_matrix(self.frame))
            of = velocity.jacobian(self.rates)
            for i, a in enumerate(self.coordinates):
                for j, b in enumerate(self.coordinates[:i]):
                    if any(not vanishes(term) for term in of[:, i].diff(b) - of[:, j].diff(a)):
                        raise RequestError(
                            f"the velocity of {point} is not that of a place in the coordinates {a}, {b}: constraints are put into it. "
                            "Give the coordinates of the place as well, and the constraints as `velocity_constraints`"
                        )

    def _forces(self, loads: Iterable[tuple[Any, Any]]) -> dict[Any, Any]:
        """The generalised forces by coordinate."""
        import sympy as sp
        from sympy.physics.mechanics import ReferenceFrame

        along = sp.zeros(len(self.u), 1)
        for place, vector in loads:
            motion = place.ang_vel_in(self.frame) if isinstance(place, ReferenceFrame) else place.vel(self.frame)
            moved = motion.to_matrix(self.frame).xreplace(self.of_speeds).jacobian(self.u)
            along += moved.T * vector.to_matrix(self.frame)
        forces = [self.in_rates(force) for force in self.map.T.LUsolve(along)]
        return {q: force for q, force in zip(self.coordinates, forces, strict=True) if force != 0}


def of_kanes(method: Any) -> dict[str, Any]:
    """The pieces of a `KanesMethod`."""
    pieces = Kanes(method)
    return {key: getattr(pieces, key) for key in ("coordinates", "lagrangian", "constraints", "positions", "forces")}


def vanishes(expression: Any) -> bool:
    """Whether an expression is zero, at some places taken at random: simplifying it may take hours."""
    import sympy as sp
    from sympy.physics.mechanics import find_dynamicsymbols

    if expression == 0:
        return True
    random = Random(1)
    free = sorted(find_dynamicsymbols(expression) | expression.free_symbols, key=str)
    free.sort(key=lambda symbol: -isinstance(symbol, sp.Derivative))
    for _ in range(3):
        number = expression
        for symbol in free:
            number = number.xreplace({symbol: sp.Float(random.uniform(0.3, 1.2))})
        if not abs(sp.N(number)) < 1e-9:
            return False
    return True
