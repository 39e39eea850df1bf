#!/usr/bin/env bash
# Starts Slurm with this host as its only node, in a folder of its own, runs a command, and ends Slurm.
#   one-node.sh FOLDER COMMAND ARGUMENTS...
set -euo pipefail
mkdir -p "$1/state" "$1/spool"
dir=$(realpath "$1"); shift
host=$(hostname -s)
free() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
(umask 077; head -c 1024 /dev/urandom > "$dir/key")
cat > "$dir/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$dir/munge.socket
SlurmctldPort=$(free)
SlurmdPort=$(free)
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,batch_sched_delay=0
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES State=UP
CONF
export SLURM_CONF="$dir/slurm.conf" PATH="$PATH:/usr/sbin"
begun=()
finish() {
  kill "${begun[@]}" 2>/dev/null || true
  wait
}
trap finish EXIT
munged --foreground --force --socket="$dir/munge.socket" --key-file="$dir/key" --pid-file="$dir/munged.pid" \
  --log-file="$dir/munged.log" --seed-file="$dir/seed" 2>> "$dir/said" & begun+=($!)
for _ in $(seq 100); do [ -S "$dir/munge.socket" ] && break; sleep 0.1; done
slurmctld -D -c -i 2>> "$dir/said" & begun+=($!)
slurmd -D -f "$dir/slurm.conf" -N "$host" 2>> "$dir/said" & begun+=($!)
for _ in $(seq 150); do
  [ "$(sinfo -h -o %t 2>/dev/null)" = idle ] && idle=1 && break
  sleep 0.2
done
if [ -z "${idle:-}" ]; then cat "$dir/said" >&2; exit 1; fi
"$@"
