//! Faults of system calls, injected by `strace`.
