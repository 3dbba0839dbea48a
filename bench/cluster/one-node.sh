#!/bin/sh
# one-node.sh - Slurm on this machine alone, for trying and testing job arrays: munged, slurmctld
# and slurmd in a folder of their own, beside any Slurm that the machine belongs to. Needs neither
# systemd nor control groups; run as root, which slurmd wants to be. Debian: `make deps-cluster`.
# Usage:  bench/cluster/one-node.sh start FOLDER [CORES]
#             starts them, with CORES cores (all of the machine without it), waits until a job can
#             run, and prints the assignments that the commands of Slurm need: set -a and eval them
#         bench/cluster/one-node.sh stop FOLDER
#             ends them and all jobs
# Logs lie in FOLDER, whose path has to be shorter than 70 bytes (names of sockets). 3: they do not
# run here; the last lines of their logs tell why.
# SPDX-License-Identifier: BSD-2-Clause
set -u
LC_ALL=C; export LC_ALL
PATH=$PATH:/usr/sbin:/sbin

die() { echo "one-node.sh: $*" >&2; exit 3; }

# Ports that nobody listens on now, as far as /proc tells; Slurm has no way to be given any port.
free_ports() {
    port=$((20000 + $$ % 20000))
    while cat /proc/net/tcp /proc/net/tcp6 2>/dev/null |
        grep -qi ":$(printf '%04x' $port) \|:$(printf '%04x' $((port + 1))) "; do
        port=$((port + 2))
    done
}

# Scheduling is attempted every second, for jobs of seconds; a cluster needs none of that.
write_configuration() {
    host=$(hostname -s)
    cat >"$folder/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,sched_min_interval=0,bf_interval=1
MailProg=/bin/true
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cores State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
    echo 'CgroupAutomount=no' >"$folder/cgroup.conf"
}

# Ends what a file with a process id names, if it is that program still.
end_daemon() {
    pid=$(cat "$folder/$1.pid" 2>/dev/null) || return 0
    grep -q "^$1" "/proc/$pid/comm" 2>/dev/null || return 0
    kill "$pid"
    for i in 1 2 3 4 5 6 7 8 9 10; do
        kill -0 "$pid" 2>/dev/null || return 0
        sleep 0.5
    done
    kill -9 "$pid"
}

stop() {
    if [ -f "$folder/slurm.conf" ]; then
        SLURM_CONF=$folder/slurm.conf; export SLURM_CONF
        jobs=$(timeout 10 squeue -h -o %A 2>/dev/null | sort -u)
        [ -z "$jobs" ] || { timeout 10 scancel $jobs; sleep 2; }
    fi
    for daemon in slurmd slurmctld munged; do end_daemon $daemon; done
}

# Says why, and leaves nothing running.
give_up() {
    tail -n 5 "$folder"/*.log >&2
    stop
    die "$1"
}

start() {
    for program in munged slurmctld slurmd sinfo sbatch; do
        command -v $program >/dev/null || die "there is no $program (make deps-cluster)"
    done
    mkdir -p "$folder/state" "$folder/spool" && chmod 755 "$folder" || exit 3
    free_ports
    write_configuration
    head -c 1024 /dev/urandom >"$folder/munge.key" && chmod 400 "$folder/munge.key" || exit 3
    # Forced: the folder may be closed to others, since all that has to reach the socket is root.
    munged --force --socket="$folder/munge.socket" --key-file="$folder/munge.key" \
        --log-file="$folder/munged.log" --pid-file="$folder/munged.pid" \
        --seed-file="$folder/munged.seed" >&2 || give_up "munged does not start"
    SLURM_CONF=$folder/slurm.conf; export SLURM_CONF
    slurmctld -f "$SLURM_CONF" >&2 || give_up "slurmctld does not start"
    slurmd -f "$SLURM_CONF" >&2 || give_up "slurmd does not start"
    for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
        if [ "$(timeout 10 sinfo -h -o %t 2>/dev/null)" = idle ]; then
            echo "SLURM_CONF='$SLURM_CONF'"
            exit 0
        fi
        sleep 1
    done
    give_up "the node does not become idle"
}

[ $# -ge 2 ] || { sed -n '2,/^# SPDX/{/^# SPDX/!s/^# \{0,1\}//p}' "$0"; exit 3; }
mkdir -p "$2" && folder=$(cd "$2" && pwd) || exit 3
[ ${#folder} -lt 70 ] || die "the path of $folder is too long"
cores=${3:-$(getconf _NPROCESSORS_ONLN)}
case $1 in start) start ;; stop) stop ;; *) die "start or stop, not $1" ;; esac
