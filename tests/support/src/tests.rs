/// A test in a short form and, ignored as slow, in full: two names, each with its call.
#[macro_export]
macro_rules! short_and_full {
    ($(#[$text:meta])* $short:ident => $check:expr; $(#[$more:meta])* $full:ident => $whole:expr;) => {
        $(#[$text])*
        #[test]
        fn $short() {
            $check;
        }

        $(#[$more])*
        #[test]
        #[ignore = "slow"]
        fn $full() {
            $whole;
        }
    };
}

/// Systems of one shape as the arms of one type, so that a method is compiled once for all of them: calls of an arm are not inlined. After the
/// arms stand further entries of the system.
#[macro_export]
macro_rules! shape {
    ($(#[$text:meta])* $vis:vis $name:ident<$n:literal, $m:literal> { $($arm:ident: $type:ty,)* } $($more:tt)*) => {
        $(#[$text])*
        #[derive(Clone)]
        $vis enum $name { $($arm($type),)* }

        $(impl From<$type> for $name {
            fn from(system: $type) -> Self { Self::$arm(system) }
        })*

        impl $crate::lagrangian::System<$n, $m> for $name {
            #[inline(never)]
            fn lagrangian<S: $crate::lagrangian::Scalar>(&self, t: S, q: &[S; $n], v: &[S; $n]) -> S {
                match self { $(Self::$arm(x) => $crate::lagrangian::System::lagrangian(x, t, q, v),)* }
            }
            #[inline(never)]
            fn constraint<S: $crate::lagrangian::Scalar>(
                &self,
                t: S,
                q: &[S; $n],
            ) -> $crate::lagrangian::Constraint<S, $n, $m> {
                match self { $(Self::$arm(x) => $crate::lagrangian::System::constraint(x, t, q),)* }
            }
            #[inline(never)]
            fn force<S: $crate::lagrangian::Scalar>(&self, t: S, q: &[S; $n], v: &[S; $n]) -> Option<[S; $n]> {
                match self { $(Self::$arm(x) => $crate::lagrangian::System::force(x, t, q, v),)* }
            }
            #[inline(never)]
            fn admissible_basis<S: $crate::lagrangian::Scalar>(
                &self,
                t: S,
                q: &[S; $n],
            ) -> Option<$crate::lagrangian::AdmissibleBasis<S, $n, $m>> {
                match self { $(Self::$arm(x) => $crate::lagrangian::System::admissible_basis(x, t, q),)* }
            }
            #[inline(never)]
            fn holonomic<S: $crate::lagrangian::Scalar>(&self, t: S, q: &[S; $n]) -> Option<[Option<S>; $m]> {
                match self { $(Self::$arm(x) => $crate::lagrangian::System::holonomic(x, t, q),)* }
            }
            #[inline(never)]
            fn nonlinear<S: $crate::lagrangian::Scalar>(
                &self,
                t: S,
                q: &[S; $n],
                v: &[S; $n],
            ) -> Option<[Option<S>; $m]> {
                match self { $(Self::$arm(x) => $crate::lagrangian::System::nonlinear(x, t, q, v),)* }
            }
            fn angles(&self) -> [bool; $n] {
                match self { $(Self::$arm(x) => $crate::lagrangian::System::angles(x),)* }
            }
            $($more)*
        }
    };
}
