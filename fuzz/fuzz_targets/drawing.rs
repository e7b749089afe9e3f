#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| beadwright_fuzz::drawing(data));
