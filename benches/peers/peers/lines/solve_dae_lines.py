"""solve_dae: Radau and BDF on the constrained equations themselves, in its authors' form of index 1, exact Jacobians."""

from solve_dae.integrate import solve_dae

from ..compiled import Compiled
from ..measure import TOLERANCES, Line


def lines(problem):
    f = Compiled(problem)
    end = problem.duration

    def prepare_by(method):
        def prepare(tolerance):
            def run():
                found = solve_dae(f.residual, (0.0, end), f.dae_start, f.dae_slope, method=method, t_eval=[end],
                                  rtol=tolerance, atol=tolerance, jac=f.residual_jacobians)
                if not found.success:
                    raise ArithmeticError(found.message)
                return found.y[:3, -1], found.nfev
            return run
        return prepare

    return [Line(f"solve_dae {m.lower()}", "solve-dae", "index 1", prepare_by(m), TOLERANCES) for m in ("Radau", "BDF")]
