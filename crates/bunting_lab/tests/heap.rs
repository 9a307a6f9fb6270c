//! Test of the counted memory. It is alone in its program, since other tests would allocate meanwhile.

use std::hint::black_box;

use bunting_lab::{commands::memory, heap::held_by};

#[test]
fn memory_is_counted_and_grows_with_the_number_of_particles() {
    let (_list, held) = held_by(|| {
        // `black_box` keeps the compiler from removing the unused memory.
        drop(black_box(vec![0_u8; 1 << 20]));
        let mut list: Vec<u64> = black_box(Vec::with_capacity(10));
        list.reserve_exact(1000);
        list
    });
    assert_eq!(held, 8000);
    let json = memory::run().json;
    let bytes = |list: &str, key: &str| -> Vec<u64> {
        let rows = json[list].as_array().expect(list).iter();
        rows.map(|row| row[key].as_u64().expect(key)).collect()
    };
    let fabrics = bytes("fabrics", "bytes");
    assert_eq!(fabrics.len(), 4);
    assert!(fabrics.windows(2).all(|pair| pair[0] > 2 * pair[1]), "{fabrics:?}");
    // A particle takes at least a position, a velocity and a normal in each lane, and 150 to 200 bytes with
    // the state of the integrator and the constraints. The single-cloth layout also stores the fabric's
    // numbers in each lane.
    for row in json["batches"].as_array().expect("batches") {
        let n = row["n"].as_u64().expect("n");
        let lanes = row["lanes"].as_u64().expect("lanes");
        let least = n * n * lanes * 36;
        let most = if lanes == 1 { 60 } else { 8 } * least;
        let held = row["bytes"].as_u64().expect("bytes");
        assert!((least..most).contains(&held), "{row}");
    }
}
