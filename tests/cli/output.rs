//! `noslip run --out`: the files of a trajectory.

use crate::program::{Folder, SCENE, csv};
use std::fs::File;

const HEADER: &str = "t [s],x [m],y [m],heading [rad],speed [m/s],turn_rate [rad/s],energy [J],constraint [m/s],\
    constraint_force [N],center_x [m],center_y [m]";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    folder
}

#[test]
fn csv_has_a_header_and_a_row_for_each_node() {
    let folder = folder();
    let text = folder.done("run scene.toml --out run.csv");
    assert!(text.contains("run.csv"), "{text}");
    let file = folder.read("run.csv");
    assert_eq!(file.lines().next(), Some(HEADER));
    let (names, rows) = csv(&file);
    assert_eq!(rows.len(), 41);
    assert!(rows.iter().all(|row| row.len() == names.len()));
    assert!(rows.iter().enumerate().all(|(k, row)| row[0].to_bits() == (k as f64 * 0.05).to_bits()));
    assert!(rows.iter().flatten().all(|number| number.is_finite()));
    // `{:?}` of what was read is what was written: every digit is there, and none too many.
    for line in file.lines().skip(1) {
        assert!(line.split(',').all(|text| format!("{:?}", text.parse::<f64>().unwrap()) == text), "{line}");
    }
    assert_eq!(folder.names(), ["run.csv", "run.csv-metadata.json", "scene.toml"]);
}

#[test]
fn every_keeps_the_first_every_nth_and_the_last() {
    let folder = folder();
    folder.done("run scene.toml --out all.csv");
    let (_, all) = csv(&folder.read("all.csv"));
    for (every, kept) in [
        (1, (0..=40).collect::<Vec<usize>>()),
        (7, vec![0, 7, 14, 21, 28, 35, 40]),
        (20, vec![0, 20, 40]),
        (40, vec![0, 40]),
        (u64::MAX, vec![0, 40]),
    ] {
        folder.done(&format!("run scene.toml --out some.csv --force --every {every}"));
        let (_, rows) = csv(&folder.read("some.csv"));
        let bits = |row: &Vec<f64>| row.iter().map(|number| number.to_bits()).collect::<Vec<u64>>();
        let expected: Vec<_> = kept.iter().map(|k| bits(&all[*k])).collect();
        assert_eq!(rows.iter().map(bits).collect::<Vec<_>>(), expected, "--every {every}");
    }
}

#[test]
fn npz_has_the_columns_of_the_csv_as_arrays() {
    let folder = folder();
    folder.done("run scene.toml --every 3 --out run.csv");
    folder.done("run scene.toml --every 3 --out run.npz");
    let (names, rows) = csv(&folder.read("run.csv"));
    let mut archive = zip::ZipArchive::new(File::open(folder.join("run.npz")).unwrap()).unwrap();
    let arrays: Vec<String> =
        archive.file_names().map(|name| name.unwrap().trim_end_matches(".npy").to_owned()).collect();
    let all: Vec<&str> = names.iter().map(String::as_str).chain(["metadata"]).collect();
    assert_eq!(arrays, all);
    // An array without dimensions, of one text.
    let metadata = npyz::NpyFile::new(archive.by_name("metadata.npy").unwrap()).unwrap();
    assert_eq!((metadata.shape(), metadata.len()), (&[][..], 1));
    drop(metadata);
    for (column, name) in names.iter().enumerate() {
        let array = npyz::NpyFile::new(archive.by_name(&format!("{name}.npy")).unwrap()).unwrap();
        assert_eq!(array.shape(), [rows.len() as u64]);
        let values: Vec<f64> = array.into_vec().unwrap();
        let bits = |value: f64| value.to_bits();
        let expected: Vec<u64> = rows.iter().map(|row| bits(row[column])).collect();
        assert_eq!(values.into_iter().map(bits).collect::<Vec<_>>(), expected, "{name}");
    }
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_has_the_columns_of_the_csv() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;
    let folder = folder();
    folder.done("run scene.toml --every 3 --out run.csv");
    folder.done("run scene.toml --every 3 --out run.parquet");
    let (_, rows) = csv(&folder.read("run.csv"));
    let reader = SerializedFileReader::new(File::open(folder.join("run.parquet")).unwrap()).unwrap();
    let read: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    assert_eq!(read.len(), rows.len());
    for (read, row) in read.iter().zip(&rows) {
        let names: Vec<&str> = read.get_column_iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names.join(","), HEADER);
        let bits = |(_, field): (&String, &Field)| match field {
            Field::Double(number) => number.to_bits(),
            other => panic!("{other}"),
        };
        let expected: Vec<u64> = row.iter().map(|number| number.to_bits()).collect();
        assert_eq!(read.get_column_iter().map(bits).collect::<Vec<_>>(), expected);
    }
}

#[cfg(not(feature = "parquet"))]
#[test]
fn a_program_without_parquet_says_how_to_get_one_with_it() {
    let folder = folder();
    folder.refused("run scene.toml --out run.parquet", &["run.parquet", "cargo build", "--features parquet"]);
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn effects_have_columns_of_their_own() {
    let folder = folder();
    let effects = "[[effects]]\nkind = \"drag\"\nalong = 0.1\n[[effects]]\nkind = \"drag\"\nturning = 0.1\n\
        [[effects]]\nkind = \"flywheel\"\ninertia = 0.5\ntorque = 0.2\n";
    folder.write("driven.toml", format!("{SCENE}{effects}"));
    let run = folder.json("run driven.toml --out run.csv --json");
    let file = folder.read("run.csv");
    let own = "rotor_angle [rad],rotor_rate [rad/s],work [J],power_drag [W],power_drag_2 [W],power_flywheel [W]";
    assert_eq!(file.lines().next(), Some(format!("{HEADER},{own}").as_str()));
    let (names, rows) = csv(&file);
    let column = |name: &str| names.iter().position(|other| other == name).unwrap();
    let (energy, work, motor) = (column("energy"), column("work"), column("power_flywheel"));
    let (rate, drag, speed) = (column("rotor_rate"), column("power_drag"), column("speed"));
    for row in &rows {
        approx::assert_relative_eq!(row[motor], 0.2 * row[rate], max_relative = 1e-15);
        approx::assert_relative_eq!(row[drag], -0.1 * row[speed] * row[speed], max_relative = 1e-14);
    }
    // What the work does not explain of the energy is what the program calls its error.
    let error = run["energy"]["max_error"].as_f64().unwrap();
    let [first, last] = [&rows[0], &rows[rows.len() - 1]];
    assert!(last[work].abs() > 10.0 * error, "{last:?}");
    assert!((last[energy] - first[energy] - last[work]).abs() <= error, "{last:?}");
}

/// Whatever does work has a column of its power, nothing else has one, and together the powers are the rate of the energy.
#[test]
fn powers_are_the_rate_of_the_energy() {
    let folder = folder();
    let servo = "[[effects]]\nkind = \"servo\"\nspeed = { amplitude = 0.5, frequency = 1.0 }\n";
    let table = "[[effects]]\nkind = \"turntable\"\nrate = 0.3\n";
    folder.write("guided.toml", format!("{}{servo}{table}", SCENE.replace("speed = -1.0", "speed = 0.5")));
    for (scene, powers) in [
        ("turntable", "turntable"),
        ("shaker", "moving_mass"),
        ("planimeter", "tracer"),
        ("thrust-well", "thrust"),
        ("braking", "drag"),
        ("guided.toml", "turntable,servo"),
    ] {
        folder.done(&format!("run {scene} --method gauss8 --step 0.01 --duration 1 --out run.csv --force"));
        let (names, rows) = csv(&folder.read("run.csv"));
        let of_powers: Vec<&str> = names.iter().filter_map(|name| name.strip_prefix("power_")).collect();
        assert_eq!(of_powers.join(","), powers, "{scene}");
        let energy = names.iter().position(|name| name == "energy").unwrap();
        let power = |row: &[f64]| row[names.len() - of_powers.len()..].iter().sum::<f64>();
        // Simpson's rule on pairs of steps, of order 4.
        let pairs = rows.windows(3).step_by(2);
        let work: f64 = pairs.map(|at| 0.01 / 3.0 * (power(&at[0]) + 4.0 * power(&at[1]) + power(&at[2]))).sum();
        let gained = rows[rows.len() - 1][energy] - rows[0][energy];
        assert!((work - gained).abs() < 1e-8 && gained.abs() > 1e-4, "{scene}: {work:e} {gained:e}");
    }
}

#[test]
fn other_endings_are_refused() {
    let folder = folder();
    for name in ["run.txt", "run", ".csv", "csv", "run.csv.gz", "run.parquett", "run.", "ru\u{e9}"] {
        folder.refused(&format!("run scene.toml --out {name}"), &[name, ".csv", ".npz"]);
    }
    folder.done("run scene.toml --out RUN.CSV");
    assert_eq!(folder.names(), ["RUN.CSV", "RUN.CSV-metadata.json", "scene.toml"]);
}
