"""SciPy: its interpreted steppers, and its compiled loops; the right-hand side compiled by numba in all of them."""

from scipy.integrate import ode, odeint, solve_ivp

from ..compiled import Compiled
from ..measure import TOLERANCES, Line


def lines(problem):
    f = Compiled(problem)
    end = problem.duration

    def stepper(method, slope, start, **options):
        def prepare(tolerance):
            def run():
                found = solve_ivp(slope, (0.0, end), start, method, t_eval=[end], rtol=tolerance, atol=tolerance, **options)
                if not found.success:
                    raise ArithmeticError(found.message)
                return found.y[:3, -1], found.nfev
            return run
        return prepare

    def lsoda(tolerance):
        def run():
            y, info = odeint(f.slope, f.start, [0.0, end], tfirst=True, rtol=tolerance, atol=tolerance, Dfun=f.jacobian,
                             mxstep=10_000_000, full_output=True)
            if info["message"] != "Integration successful.":
                raise ArithmeticError(info["message"])
            return y[-1, :3], info["nst"][-1]
        return run

    def compiled_dop853(tolerance):
        evaluations = []

        def counted(t, y):
            evaluations[0] += 1
            return f.slope(t, y)

        def run():
            # The loop tells no number of steps: evaluations are counted in the first run, which is not timed.
            first = not evaluations
            if first:
                evaluations.append(0)
            solver = ode(counted if first else f.slope).set_integrator("dop853", rtol=tolerance, atol=tolerance, nsteps=10_000_000)
            solver.set_initial_value(f.start, 0.0)
            y = solver.integrate(end)
            if not solver.successful():
                raise ArithmeticError(f"return code {solver.get_return_code()}")
            return y[:3], evaluations[0]
        return run

    return [
        Line("scipy dop853", "scipy", "reduced", stepper("DOP853", f.slope, f.start), TOLERANCES),
        Line("scipy dop853 full", "scipy", "full", stepper("DOP853", f.full_slope, f.full_start), TOLERANCES),
        Line("scipy dop853 compiled loop", "scipy", "reduced", compiled_dop853, TOLERANCES),
        Line("scipy radau", "scipy", "reduced", stepper("Radau", f.slope, f.start, jac=f.jacobian), TOLERANCES),
        Line("scipy lsoda", "scipy", "reduced", lsoda, TOLERANCES),
    ]
