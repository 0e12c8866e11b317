"""The pieces of a system from the methods of `sympy.physics.mechanics`; imported where one is given, since SymPy need not be there."""

from __future__ import annotations

from collections.abc import Iterable
from random import Random
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray
from sympy.physics.mechanics import KanesMethod, LagrangesMethod, ReferenceFrame, dynamicsymbols, find_dynamicsymbols

from ._noslip import RequestError
from .errors import ArgumentError


def of_lagranges(method: Any) -> dict[str, Any]:
    """Those of a `LagrangesMethod`: its Lagrangian, forces and constraints."""
    _expect(LagrangesMethod, method)
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
        _expect(KanesMethod, method)
        if method._uaux:
            raise RequestError("auxiliary speeds have no place in a system")
        self.frame = method._inertial
        self.coordinates, self.u = list(method.q), list(method.u)
        self.time = dynamicsymbols._t
        self.rates = [q.diff(self.time) for q in self.coordinates]
        # The rates as functions of the speeds, affine in them, and the other way round.
        self.of_speeds = method.kindiffdict()
        right = sp.Matrix([self.of_speeds[rate] for rate in self.rates])
        self.map = right.jacobian(self.u)
        rest = right.xreplace(dict.fromkeys(self.u, sp.Integer(0)))
        self.of_rates = dict(zip(self.u, self.map.LUsolve(sp.Matrix(self.rates) - rest), strict=True))
        # Coordinates that do not depend on the time, for partial derivatives; the time is one more, of rate one.
        self.still = {q: sp.Dummy(str(q)) for q in self.coordinates}
        self.names, self.places = [*self.coordinates, self.time], [*self.still.values(), self.time]
        self.positions = list(method._f_h)
        self.zero = sp.Matrix(self.positions).xreplace(self.still)
        self.slope = self.zero.jacobian(self.places) if self.positions else sp.zeros(0, len(self.places))

        loads = [(place, vector) for place, vector in method.forcelist or ()]
        moving = [body.masscenter if hasattr(body, "masscenter") else body.point for body in method.bodies]
        turning = [body.frame for body in method.bodies if hasattr(body, "frame")]
        for part in dict.fromkeys([*moving, *turning, *(place for place, _ in loads)]):
            self._refuse_reduced(part)
        self.lagrangian = self.in_rates(sum(body.kinetic_energy(self.frame) for body in method.bodies))
        self.forces = self._forces(loads)
        rows = [self.in_rates(row) for row in method._k_nh * sp.Matrix(self.u) + method._f_nh] if method._k_nh else []
        if method._k_dnh and method._k_dnh is not method._k_nh:
            self._refuse_accelerations(method._k_dnh, method._f_dnh, rows)
        self.constraints = self._further(rows)

    def in_rates(self, expression: Any) -> Any:
        """An expression of speeds as one of rates."""
        return sp.sympify(expression).xreplace(self.of_speeds).xreplace(self.of_rates)

    def _affine(self, expressions: Any) -> Any:
        """Expressions that are affine in the rates, as a matrix: a column for each rate, and the rest."""
        rows = sp.Matrix(expressions)
        rest = rows.xreplace(dict.fromkeys(self.rates, sp.Integer(0)))
        return rows.jacobian(self.rates).row_join(rest).xreplace(self.still)

    def _motion(self, part: Any) -> Any:
        """The velocity of a point, or the angular velocity of a frame."""
        return part.ang_vel_in(self.frame) if isinstance(part, ReferenceFrame) else part.vel(self.frame)

    def _refuse_reduced(self, part: Any) -> None:
        """Refuses velocities that are not those of places in the coordinates, and angular velocities that are not those of attitudes:
        constraints have been put into them.

        Kane's equations may have such velocities. A Lagrangian with them would give the motion of another system.
        """
        turns = isinstance(part, ReferenceFrame)
        motion = self._affine(self.in_rates(self._motion(part).to_matrix(self.frame)))
        # The second derivatives of a place agree; those of an attitude but for the cross product of its rates of turning.
        pairs = [(i, j) for i in range(len(self.places)) for j in range(i)]
        twists = []
        for i, j in pairs:
            one, other = motion[:, i], motion[:, j]
            twist = other.diff(self.places[i]) - one.diff(self.places[j])
            twists.append(twist - one.cross(other) if turns else twist)
        both = motion.row_join(sp.Matrix.hstack(*twists))
        if both[:, len(self.places) :].is_zero_matrix:
            return
        for numbers in self._somewhere(both):
            found = in_numbers(both, numbers)
            sizes, found = np.abs(found[:, : len(self.places)]), found[:, len(self.places) :]
            form = np.zeros((3, len(self.places), len(self.places)), dtype=complex)
            for (i, j), column in zip(pairs, found.T, strict=True):
                form[:, i, j], form[:, j, i] = column, -column
            along = self._admissible(numbers)
            if np.abs(along.T @ form @ along.conj()).max() > 1e-9 * max(1.0, sizes.max() ** 2):
                i, j = pairs[int(np.abs(found).max(axis=0).argmax())]
                what, of = ("angular velocity", "an attitude") if turns else ("velocity", "a place")
                raise RequestError(
                    f"the {what} of {part} is not that of {of} in the coordinates {self.names[j]}, {self.names[i]}: constraints are put "
                    f"into it. Give the coordinates of the {of.split()[-1]} as well, and the constraints as `velocity_constraints`"
                )

    def _somewhere(self, matrix: Any) -> Iterable[dict[Any, Any]]:
        """Numbers for all symbols of a matrix: places taken at random, with the positions at zero as far as that is found."""
        free = {symbol for entry in [*matrix, *self.zero] for symbol in symbols(entry)} | set(self.places)
        random = Random(1)
        for _ in range(3):
            numbers = {symbol: sp.Float(random.uniform(0.3, 1.2)) for symbol in sorted(free, key=str)}
            for _ in range(50 if self.positions else 0):
                residual = in_numbers(self.zero, numbers).ravel()
                if np.abs(residual).max() < 1e-13:
                    break
                slope = in_numbers(self.slope, numbers)[:, :-1]
                change = np.linalg.lstsq(slope, residual, rcond=None)[0].real
                change *= min(1.0, 0.5 / (np.abs(change).max() or 1.0))
                numbers.update({q: numbers[q] - sp.Float(x) for q, x in zip(self.places, change)})
            yield numbers

    def _admissible(self, numbers: dict[Any, Any]) -> NDArray[Any]:
        """The directions, time included, that keep the positions at zero."""
        if not self.positions:
            return np.eye(len(self.places))
        _, sizes, right = np.linalg.svd(in_numbers(self.slope, numbers))
        return right[int((sizes > 1e-7 * sizes[0]).sum()) :].T

    def _refuse_accelerations(self, matrix: Any, rest: Any, rows: list[Any]) -> None:
        """Refuses constraints on accelerations that are not the derivatives of those on velocities."""
        changes = {u.diff(self.time): sp.sympify(speed).diff(self.time) for u, speed in self.of_rates.items()}
        for given, row in zip(matrix * sp.Matrix([u.diff(self.time) for u in self.u]) + rest, rows, strict=True):
            terms = sp.Matrix([self.in_rates(given.xreplace(changes)), row.diff(self.time)])
            random = Random(1)
            for _ in range(3):
                free = {symbol for term in terms for symbol in symbols(term)}
                numbers = {symbol: sp.Float(random.uniform(0.3, 1.2)) for symbol in sorted(free, key=str)}
                [one], [other] = in_numbers(terms, numbers)
                if abs(one - other) > 1e-9 * max(1.0, abs(one)):
                    raise RequestError(
                        f"the constraint on accelerations {given} is not the derivative of {row}: constraints of a system are on positions "
                        "and on velocities"
                    )

    def _further(self, rows: list[Any]) -> list[Any]:
        """The rows that say more than the positions, whose rates are among them, and than the rows before."""
        if not rows or not self.positions:
            return rows
        affine = self._affine([*(sp.sympify(position).diff(self.time) for position in self.positions), *rows])
        matrices = [in_numbers(affine, numbers) for numbers in self._somewhere(affine)]
        said, kept = list(range(len(self.positions))), []
        for k, row in enumerate(rows, len(self.positions)):
            if any(rank(matrix[[*said, k]]) > rank(matrix[said]) for matrix in matrices):
                said.append(k)
                kept.append(row)
        return kept

    def _forces(self, loads: Iterable[tuple[Any, Any]]) -> dict[Any, Any]:
        """The generalised forces by coordinate."""
        along = sp.zeros(len(self.u), 1)
        for place, vector in loads:
            moved = self._motion(place).to_matrix(self.frame).xreplace(self.of_speeds).jacobian(self.u)
            along += moved.T * vector.to_matrix(self.frame)
        forces = [self.in_rates(force) for force in self.map.T.LUsolve(along)]
        return {q: force for q, force in zip(self.coordinates, forces, strict=True) if force != 0}


def of_kanes(method: Any) -> dict[str, Any]:
    """The pieces of a `KanesMethod`."""
    pieces = Kanes(method)
    return {key: getattr(pieces, key) for key in ("coordinates", "lagrangian", "constraints", "positions", "forces")}


def _expect(kind: type, method: Any) -> None:
    """Refuses what is no such object of SymPy."""
    if not isinstance(method, kind):
        raise ArgumentError(f"accepted is a sympy.physics.mechanics.{kind.__name__}, and not {method!r}")


def symbols(expression: Any) -> set[Any]:
    """The symbols of an expression, its functions of the time, and their derivatives."""
    return set(find_dynamicsymbols(expression) | expression.free_symbols)


def in_numbers(matrix: Any, numbers: dict[Any, Any]) -> NDArray[Any]:
    """A matrix in numbers. All symbols are replaced at once: the time is within the functions of it."""
    return np.array([complex(sp.N(entry.xreplace(numbers))) for entry in matrix]).reshape(matrix.shape)


def rank(rows: NDArray[Any]) -> int:
    """The rank of some rows, however long each of them is."""
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    return int(np.linalg.matrix_rank(rows / np.where(lengths > 0.0, lengths, 1.0), tol=1e-7))
