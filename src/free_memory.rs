//! Memory that this process can still get, where Linux shows it.

const MIB: f64 = 1048576.;

/// In MiB or GiB, with three digits or four.
pub fn in_words(bytes: f64) -> String {
    match bytes / MIB {
        few if few < 1024. => format!("{few:.0} MiB"),
        many => format!("{:.1} GiB", many / 1024.),
    }
}

/// [bytes] What programs and the disk's cache leave, swap included, or what a limit on the addresses of this process
/// leaves, if that is less.
pub fn free_memory() -> Option<f64> {
    let read = |name: &str| std::fs::read_to_string(format!("/proc/{name}")).ok();
    let machine = read("meminfo").and_then(|text| left_by_others(&text));
    let limit =
        read("self/limits").zip(read("self/status")).and_then(|(limits, status)| left_by_limit(&limits, &status));
    machine.into_iter().chain(limit).reduce(f64::min)
}

/// Of /proc/meminfo.
fn left_by_others(meminfo: &str) -> Option<f64> {
    Some(kilobytes(meminfo, "MemAvailable:")? + kilobytes(meminfo, "SwapFree:").unwrap_or(0.))
}

/// Of /proc/self/limits and /proc/self/status, without the addresses that are taken but hold nothing yet: the allocator
/// takes 64 MiB of them for each thread, and does without where it cannot. None if addresses are not limited.
fn left_by_limit(limits: &str, status: &str) -> Option<f64> {
    let limit: f64 = after(limits, "Max address space")?.parse().ok()?;
    Some(limit - kilobytes(status, "VmData:")?)
}

fn kilobytes(text: &str, name: &str) -> Option<f64> {
    after(text, name)?.parse().ok().map(|kilobytes: f64| 1024. * kilobytes)
}

/// The first word behind the name that begins a line.
fn after<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    text.lines().find_map(|line| line.strip_prefix(name))?.split_whitespace().next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_free_is_read_as_linux_writes_it() {
        let meminfo = "MemTotal:       24576000 kB\nMemFree:          100000 kB\nMemAvailable:    2048000 kB\nSwapFree:   1000 kB\n";
        assert_eq!(left_by_others(meminfo), Some(2049000. * 1024.));
        let limits = "Limit                     Soft Limit           Hard Limit           Units     \n\
                      Max resident set          unlimited            unlimited            bytes     \n\
                      Max address space         614400000            unlimited            bytes     \n";
        assert_eq!(
            left_by_limit(limits, "VmSize:\t  300000 kB\nVmData:\t  200000 kB\n"),
            Some(614400000. - 204800000.)
        );
        assert_eq!(left_by_limit(&limits.replace("614400000", "unlimited"), "VmData:\t  200000 kB\n"), None);
        assert_eq!((left_by_others(""), left_by_limit("", "")), (None, None));
    }

    #[test]
    fn sizes_have_three_digits_or_four() {
        assert_eq!([2.7 * MIB, 700.4 * MIB, 3.12 * 1024. * MIB].map(in_words), ["3 MiB", "700 MiB", "3.1 GiB"]);
    }
}
