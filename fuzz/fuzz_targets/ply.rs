#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| npr_fuzz::ply(bytes));
