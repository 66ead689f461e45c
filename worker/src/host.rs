//! What is known about this machine.

/// Name of the machine, as the network knows it.
#[must_use]
pub fn name() -> String {
    let name = rustix::system::uname().nodename().to_string_lossy().into_owned();
    if name.is_empty() { "unnamed".to_owned() } else { name }
}

/// Hardware class: results of one class must agree bit for bit. The code path is part of it, so that a difference
/// between the paths shows up as what it is.
#[must_use]
pub fn hardware() -> String {
    let path = lanes();
    format!("{}-{path}", std::env::consts::ARCH)
}

#[cfg(target_arch = "x86_64")]
fn lanes() -> &'static str {
    let avx2 = std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma");
    if avx2 { "avx2" } else { "sse2" }
}

#[cfg(not(target_arch = "x86_64"))]
fn lanes() -> &'static str {
    "plain"
}

/// Cores this process may use.
#[must_use]
pub fn cores() -> u32 {
    std::thread::available_parallelism().map_or(1, |cores| u32::try_from(cores.get()).unwrap_or(1))
}

/// Lowers the priority of the calling thread and of every thread it starts later.
///
/// # Errors
/// When the system refuses (raising the priority needs rights).
pub fn be_nice(level: i32) -> std::io::Result<()> {
    rustix::process::nice(level)?;
    Ok(())
}
