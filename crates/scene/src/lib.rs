//! Scene files: from TOML to a system of concrete type.
