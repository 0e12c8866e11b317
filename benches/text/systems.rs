//! The systems of scenes of text as text at compile time, with a basis where the constraints alone do not give one.

noslip::system! {
    pub(crate) struct KnifeEdge;
    coordinates = { x = "m", y = "m", theta = "angle" }
    parameters = { m = 1.0, I = 0.5, g = 9.81, slope = 0.1 }
    lagrangian = "m/2*(x'^2 + y'^2) + I/2*theta'^2 + m*g*sin(slope)*x"
    constraints = ["y'*cos(theta) - x'*sin(theta)"]
}

noslip::system! {
    pub(crate) struct RollingDisk;
    coordinates = { x = "m", y = "m", phi = "angle", theta = "angle" }
    parameters = { m = 1.0, R = 0.5, I = 0.125, J = 0.0625 }
    lagrangian = "m/2*(x'^2 + y'^2) + I/2*phi'^2 + J/2*theta'^2"
    constraints = ["x' - R*phi'*cos(theta)", "y' - R*phi'*sin(theta)"]
}

noslip::system! {
    pub(crate) struct RollerRacer;
    coordinates = { x = "m", y = "m", theta = "angle", phi = "angle" }
    parameters = { m = 1.0, I1 = 0.4, I2 = 0.1, d1 = 0.5, d2 = 0.3 }
    lagrangian = "m/2*(x'^2 + y'^2) + I1/2*theta'^2 + I2/2*(theta' + phi')^2"
    constraints = [
        "y'*cos(theta) - x'*sin(theta)",
        "y'*cos(theta + phi) - x'*sin(theta + phi) + (d1*cos(phi) + d2)*theta' + d2*phi'",
    ]
}

/// The snakeboard, and whatever its text has besides.
macro_rules! snakeboard {
    ($name:ident; $($more:tt)*) => {
        noslip::system! {
            pub(crate) struct $name;
            coordinates = { x = "m", y = "m", theta = "angle", psi = "angle", phi = "angle" }
            parameters = { m = 6.0, l = 0.2, J = 0.016, Jr = 0.072, Jw = 0.0013, twist = 0.5, steer = 0.02, rate = 3.0 }
            let = { c = "cos(theta)", s = "sin(theta)", ahead = "x'*c + y'*s" }
            lagrangian = "m/2*(x'^2 + y'^2) + J/2*theta'^2 + Jr/2*(theta' + psi')^2
                + Jw/2*((theta' + phi')^2 + (theta' - phi')^2)"
            constraints = ["y'*c - x'*s", "sin(phi)*ahead + l*cos(phi)*theta'"]
            forces = { psi = "twist*cos(rate*t)", phi = "steer*cos(rate*t)" }
            $($more)*
        }
    };
}
snakeboard! { SnakeboardWithoutBasis; }
snakeboard! {
    Snakeboard;
    basis = [
        ["l*cos(phi)*c", "l*cos(phi)*s", "-sin(phi)", "0", "0"],
        ["0", "0", "0", "1", "0"],
        ["0", "0", "0", "0", "1"],
    ]
}

noslip::system! {
    pub(crate) struct ChaplyginBall;
    coordinates = { x = "m", y = "m", e0 = "", e1 = "", e2 = "", e3 = "" }
    parameters = { m = 1.0, r = 1.0, I1 = 0.4, I2 = 0.6, I3 = 0.9 }
    let = {
        mean = "(I1 + I2 + I3)/3",
        b1 = "2*(e0*e1' - e1*e0' - e2*e3' + e3*e2')",
        b2 = "2*(e0*e2' - e2*e0' - e3*e1' + e1*e3')",
        b3 = "2*(e0*e3' - e3*e0' - e1*e2' + e2*e1')",
        w1 = "2*(e0*e1' - e1*e0' + e2*e3' - e3*e2')",
        w2 = "2*(e0*e2' - e2*e0' + e3*e1' - e1*e3')",
    }
    lagrangian = "m/2*(x'^2 + y'^2) + 2*mean*(e0'^2 + e1'^2 + e2'^2 + e3'^2)
        + ((I1 - mean)*b1^2 + (I2 - mean)*b2^2 + (I3 - mean)*b3^2)/2"
    constraints = ["x' - r*w2", "y' + r*w1"]
    positions = ["(e0^2 + e1^2 + e2^2 + e3^2 - 1)/2"]
    basis = [
        ["2*r*(e1*e2 + e0*e3)", "-r*(e0^2 + e1^2 - e2^2 - e3^2)", "-e1/2", "e0/2", "e3/2", "-e2/2"],
        ["r*(e0^2 - e1^2 + e2^2 - e3^2)", "-2*r*(e1*e2 - e0*e3)", "-e2/2", "-e3/2", "e0/2", "e1/2"],
        ["2*r*(e2*e3 - e0*e1)", "-2*r*(e1*e3 + e0*e2)", "-e3/2", "e2/2", "-e1/2", "e0/2"],
    ]
}

noslip::system! {
    pub(crate) struct Robot;
    coordinates = { x = "m", y = "m", theta = "angle", right = "angle", left = "angle" }
    parameters = { m = 4.0, J = 0.1, Jw = 0.005, a = 0.05, b = 0.15, r = 0.05, friction = 0.02, push_right = 0.12, push_left = 0.1 }
    let = { c = "cos(theta)", s = "sin(theta)", ahead = "x'*c + y'*s" }
    lagrangian = "m/2*((x' - a*theta'*s)^2 + (y' + a*theta'*c)^2) + J/2*theta'^2 + Jw/2*(right'^2 + left'^2)"
    constraints = ["y'*c - x'*s", "ahead + b*theta' - r*right'", "ahead - b*theta' - r*left'"]
    forces = { right = "push_right - friction*right'", left = "push_left - friction*left'" }
    basis = [
        ["r*c/2", "r*s/2", "r/(2*b)", "1", "0"],
        ["r*c/2", "r*s/2", "-r/(2*b)", "0", "1"],
    ]
}

noslip::system! {
    pub(crate) struct Car;
    coordinates = { x = "m", y = "m", theta = "angle", delta = "rad", behind = "angle" }
    parameters = { m = 1200.0, J = 1500.0, a = 1.2, L = 2.5, Js = 2.0, mt = 400.0, Jt = 200.0, b = 2.0, push = 800.0, drag = 60.0, swing = 0.3 }
    let = {
        c = "cos(theta)",
        s = "sin(theta)",
        cb = "cos(behind)",
        sb = "sin(behind)",
        ahead = "x'*c + y'*s",
    }
    lagrangian = "m/2*((x' - a*theta'*s)^2 + (y' + a*theta'*c)^2) + J/2*theta'^2 + Js/2*(theta' + delta')^2
        + mt/2*((x' + b*behind'*sb)^2 + (y' - b*behind'*cb)^2) + Jt/2*behind'^2"
    constraints = [
        "y'*c - x'*s",
        "y'*cos(theta + delta) - x'*sin(theta + delta) + L*cos(delta)*theta'",
        "y'*cb - x'*sb - b*behind'",
    ]
    forces = {
        x = "(push - drag*ahead)*c",
        y = "(push - drag*ahead)*s",
        delta = "200*(swing*sin(0.5*t) - delta) - 60*delta'",
    }
    basis = [
        ["L*cos(delta)*c", "L*cos(delta)*s", "sin(delta)", "0", "L*cos(delta)*sin(theta - behind)/b"],
        ["0", "0", "0", "1", "0"],
    ]
}

noslip::system! {
    pub(crate) struct FallingDisk;
    coordinates = { x = "m", y = "m", phi = "angle", theta = "angle", psi = "angle" }
    parameters = { m = 1.0, r = 1.0, g = 9.81 }
    let = {
        I = "m*r^2/2",
        J = "m*r^2/4",
        ahead = "x'*cos(phi) + y'*sin(phi)",
        across = "y'*cos(phi) - x'*sin(phi)",
        turn = "phi'*sin(theta) + psi'",
    }
    lagrangian = "m/2*((ahead - r*phi'*sin(theta))^2 + (across + r*theta'*cos(theta))^2 + (r*theta'*sin(theta))^2)
        + J/2*(theta'^2 + (phi'*cos(theta))^2) + I/2*turn^2 - m*g*r*cos(theta)"
    constraints = ["x' + r*psi'*cos(phi)", "y' + r*psi'*sin(phi)"]
}

noslip::system! {
    pub(crate) struct TwoSleighs;
    coordinates = { x = "m", y = "m", theta = "angle", x2 = "m", y2 = "m", theta2 = "angle" }
    parameters = { m = 1.0, I = 0.3, a = 0.2, m2 = 0.7, I2 = 0.2, a2 = 0.1, L = 0.4, L2 = 0.5 }
    let = { c = "cos(theta)", s = "sin(theta)", c2 = "cos(theta2)", s2 = "sin(theta2)" }
    lagrangian = "m/2*((x' - a*theta'*s)^2 + (y' + a*theta'*c)^2) + I/2*theta'^2
        + m2/2*((x2' - a2*theta2'*s2)^2 + (y2' + a2*theta2'*c2)^2) + I2/2*theta2'^2"
    constraints = ["y'*c - x'*s", "y2'*c2 - x2'*s2"]
    positions = ["x - L*c - x2 - L2*c2", "y - L*s - y2 - L2*s2"]
    basis = [
        ["c", "s", "0", "cos(theta - theta2)*c2", "cos(theta - theta2)*s2", "sin(theta - theta2)/L2"],
        ["0", "0", "1", "L*sin(theta - theta2)*c2", "L*sin(theta - theta2)*s2", "-L*cos(theta - theta2)/L2"],
    ]
}

noslip::system! {
    pub(crate) struct QuarticOscillator;
    coordinates = { x = "m", y1 = "m", y2 = "m", y3 = "m", z1 = "m", z2 = "m", z3 = "m" }
    parameters = { c = 1.0 }
    lagrangian = "(x'^2 + y1'^2 + y2'^2 + y3'^2 + z1'^2 + z2'^2 + z3'^2 - x^2 - y1^2 - y2^2 - y3^2 - z1^2 - z2^2 - z3^2
        - c*(y1^2*z1^2 + y2^2*z2^2 + y3^2*z3^2 + z1^2*z2^2))/2"
    constraints = ["x' + y1*z1' + y2*z2' + y3*z3'"]
    basis = [
        ["0", "1", "0", "0", "0", "0", "0"],
        ["0", "0", "1", "0", "0", "0", "0"],
        ["0", "0", "0", "1", "0", "0", "0"],
        ["-y1", "0", "0", "0", "1", "0", "0"],
        ["-y2", "0", "0", "0", "0", "1", "0"],
        ["-y3", "0", "0", "0", "0", "0", "1"],
    ]
}

noslip::system! {
    pub(crate) struct BallInBowl;
    coordinates = { x = "m", y = "m", e0 = "", e1 = "", e2 = "", e3 = "" }
    parameters = { m = 1.0, a = 0.1, I = 0.004, k = 0.8, g = 9.81, Omega = 0.6 }
    let = {
        square = "e0^2 + e1^2 + e2^2 + e3^2",
        n3 = "1/sqrt(1 + k^2*(x^2 + y^2))",
        n1 = "-k*x*n3",
        n2 = "-k*y*n3",
        px = "x - a*n1",
        py = "y - a*n2",
        w1 = "2*(e0*e1' - e1*e0' + e2*e3' - e3*e2')",
        w2 = "2*(e0*e2' - e2*e0' + e3*e1' - e1*e3')",
        w3 = "2*(e0*e3' - e3*e0' + e1*e2' - e2*e1')",
    }
    lagrangian = "m/2*(x'^2 + y'^2 + (k*(x*x' + y*y'))^2) + 2*I*(e0'^2 + e1'^2 + e2'^2 + e3'^2) - m*g*k/2*(x^2 + y^2)"
    constraints = ["x' - a*(w2*n3 - w3*n2) + Omega*py", "y' - a*(w3*n1 - w1*n3) - Omega*px"]
    positions = ["(e0^2 + e1^2 + e2^2 + e3^2 - 1)/2"]
    basis = [
        ["0", "-a*n3*square", "-e1/2", "e0/2", "-e3/2", "e2/2"],
        ["a*n3*square", "0", "-e2/2", "e3/2", "e0/2", "-e1/2"],
        ["-a*n2*square", "a*n1*square", "-e3/2", "-e2/2", "e1/2", "e0/2"],
    ]
}

noslip::system! {
    pub(crate) struct DrivenRobot;
    coordinates = { x = "m", y = "m", theta = "angle", right = "angle", left = "angle" }
    parameters = { m = 12.0, I = 0.6, Jw = 0.02, d = 0.08, e = 0.03, r = 0.1, b = 0.2 }
    let = { c = "cos(theta)", s = "sin(theta)", ahead = "x'*c + y'*s" }
    lagrangian = "m/2*((x' - theta'*(d*s + e*c))^2 + (y' + theta'*(d*c - e*s))^2)
        + I/2*theta'^2 + Jw/2*(right'^2 + left'^2)"
    constraints = ["y'*c - x'*s", "ahead + b*theta' - r*right'", "ahead - b*theta' - r*left'"]
    forces = { right = "0.5 + 0.3*sin(1.3*t) - 0.05*right'", left = "0.5 + 0.3*cos(1.7*t) - 0.05*left'" }
    basis = [
        ["r*c/2", "r*s/2", "r/(2*b)", "1", "0"],
        ["r*c/2", "r*s/2", "-r/(2*b)", "0", "1"],
    ]
}

noslip::system! {
    pub(crate) struct ModelCar;
    coordinates = { x = "m", y = "m", theta = "angle", delta = "angle", behind = "angle" }
    parameters = { m = 20.0, J = 1.5, Js = 0.05, mt = 8.0, Jt = 0.5, a = 0.3, L = 0.6, h = 0.1, lt = 0.7, at = 0.2 }
    let = {
        c = "cos(theta)",
        s = "sin(theta)",
        cb = "cos(behind)",
        sb = "sin(behind)",
        turn = "sin(delta)/(L*cos(delta))",
        push = "6 + 2*sin(t)",
    }
    lagrangian = "m/2*((x' - a*theta'*s)^2 + (y' + a*theta'*c)^2) + J/2*theta'^2 + Js/2*(theta' + delta')^2
        + mt/2*((x' + h*theta'*s + (lt - at)*behind'*sb)^2 + (y' - h*theta'*c - (lt - at)*behind'*cb)^2) + Jt/2*behind'^2"
    constraints = [
        "y'*c - x'*s",
        "y'*cos(theta + delta) - x'*sin(theta + delta) + L*cos(delta)*theta'",
        "y'*cb - x'*sb - h*cos(theta - behind)*theta' - lt*behind'",
    ]
    forces = { x = "push*c - 3*x'", y = "push*s - 3*y'", delta = "0.05*cos(0.7*t) - 0.1*delta' - 0.2*sin(delta)" }
    basis = [
        ["c", "s", "turn", "0", "(sin(theta - behind) - h*cos(theta - behind)*turn)/lt"],
        ["0", "0", "0", "1", "0"],
    ]
}

noslip::system! {
    pub(crate) struct Coin;
    coordinates = { x = "m", y = "m", phi = "angle", theta = "angle", psi = "angle" }
    parameters = { m = 1.0, r = 0.5, I = 0.125, J = 0.0625, g = 9.81 }
    let = { c = "cos(phi)", s = "sin(phi)", across = "r*cos(theta)*theta'", along = "-r*sin(theta)*phi'" }
    lagrangian = "m/2*((x' - s*across + c*along)^2 + (y' + c*across + s*along)^2 + (r*sin(theta)*theta')^2)
        + I/2*(psi' - sin(theta)*phi')^2 + J/2*((cos(theta)*phi')^2 + theta'^2) - m*g*r*cos(theta)"
    constraints = ["x' - r*c*psi'", "y' - r*s*psi'"]
    basis = [
        ["0", "0", "1", "0", "0"],
        ["0", "0", "0", "1", "0"],
        ["r*c", "r*s", "0", "0", "1"],
    ]
}
