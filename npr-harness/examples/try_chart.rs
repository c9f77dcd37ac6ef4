use npr_harness::chart::*;
use npr_harness::executor::*;
use npr_harness::measure::*;
fn main() {
    let size = (640, 360);
    let mut ex = Executor::all().unwrap();
    ex.rotate_left(1);
    let quick = std::env::args().nth(2).is_some();
    let size = if quick { (320, 180) } else { size };
    let subjects = built_in_subjects(size, if quick { 1 } else { 3 });
    let rounds = Rounds { rounds: if quick { 5 } else { 9 }, ..Default::default() };
    for c in charts() {
        if let Some(n) = std::env::args().nth(1) {
            if n != "all" && n != c.name {
                continue;
            }
        }
        let lab = Lab {
            executors: &ex,
            skipped: &|s| println!("skip {s}"),
            subjects: &subjects,
            size,
            rounds,
            progress: &|_| {},
        };
        let t = std::time::Instant::now();
        match (c.run)(&lab) {
            Ok(rows) => {
                let table = Table { machine: vec![], skipped: vec![], rows };
                let ps = table.points(c.name);
                let f = front::front(&ps);
                println!("{} {} s", c.name, t.elapsed().as_secs_f64());
                for (i, p) in ps.iter().enumerate() {
                    println!(
                        "  {}{:44} {:20} {:8.4}  x{:.3} [{:.3} {:.3}] {}",
                        if f.contains(&i) { "*" } else { " " },
                        p.variant,
                        p.executor,
                        p.error(),
                        p.relative.median,
                        p.relative.low,
                        p.relative.high,
                        p.errors[1..].iter().map(|e| format!("{}={:.4}", e.0, e.1)).collect::<Vec<_>>().join(" ")
                    );
                }
            }
            Err(e) => println!("{} ERR {e}", c.name),
        }
    }
}
