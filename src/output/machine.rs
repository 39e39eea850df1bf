//! Available memory and disk space of the machine.

use std::fs;
use std::path::Path;

/// Memory available to the process [byte]: available memory of the system, within the limits of the process and its control group. `None`
/// if the system does not report it.
pub fn memory() -> Option<f64> {
    let meminfo = fs::read_to_string("/proc/meminfo").ok()?;
    let available = kilobytes(&meminfo, "MemAvailable:")?;
    let limits = [group(), address_space()];
    Some(limits.into_iter().flatten().fold(available, f64::min))
}

/// Free space for a user at a path that exists or will exist [byte]. `None` for file systems without storage, such as `/proc`.
pub fn free(path: &Path) -> Option<f64> {
    let there = path.ancestors().find(|part| part.exists()).unwrap_or(Path::new("."));
    let statistics = rustix::fs::statvfs(there)
        .ok()
        .filter(|statistics| statistics.f_blocks > 0)?;
    Some(statistics.f_bavail as f64 * statistics.f_frsize as f64)
}

/// Converts a line `NAME   123 kB` to bytes.
fn kilobytes(text: &str, name: &str) -> Option<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    Some(1024.0 * line.trim().trim_end_matches("kB").trim().parse::<f64>().ok()?)
}

/// Memory limit of the control group of the process [byte].
fn group() -> Option<f64> {
    let groups = fs::read_to_string("/proc/self/cgroup").ok()?;
    let own = groups.lines().find_map(|line| line.strip_prefix("0::"))?;
    let places = [
        format!("/sys/fs/cgroup{own}/memory.max"),
        "/sys/fs/cgroup/memory.max".into(),
    ];
    let limits = places
        .iter()
        .filter_map(|place| fs::read_to_string(place).ok()?.trim().parse::<f64>().ok());
    limits.reduce(f64::min)
}

/// Remaining address space of the process [byte]. `None` without a limit.
pub fn address_space() -> Option<f64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let limit = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let most: f64 = limit.split_whitespace().next()?.parse().ok()?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    Some((most - kilobytes(&status, "VmSize:")?).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_in_bytes() {
        let text = "MemTotal:  10 kB\nMemAvailable:    3 kB\n";
        assert_eq!(kilobytes(text, "MemAvailable:"), Some(3072.0));
        assert_eq!(kilobytes(text, "MemFree:"), None);
    }
}
