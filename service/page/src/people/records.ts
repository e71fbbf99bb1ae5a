// What the service keeps of a person: fits and scans, each with what it measured.
import { useEffect, useState } from "preact/hooks";
import { eraseFit, eraseScan, getResult, getScanResult, listFits, listScans } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Job, Measurement, Problem, Scan } from "../api/types";
import { forget } from "../history/store";

export interface PersonRecord {
  readonly kind: "fit" | "scan";
  readonly job: Job | Scan;
  /** Of what has a result; empty where measurements are withheld, or the record is older than those compared. */
  readonly measurements: readonly Measurement[];
  readonly gender: string | null;
}

/** So many of the newest are measured up: each is a file to load. */
export const MOST_COMPARED = 40;

interface Found {
  /** Newest first; null until they are there. */
  readonly records: readonly PersonRecord[] | null;
  readonly problem: Problem | null;
}

export function useRecords(label: string): Found {
  const [found, setFound] = useState<Found>({ records: null, problem: null });
  useEffect(() => {
    let gone = false;
    setFound({ records: null, problem: null });
    recordsOf(label).then(
      (records) => gone || setFound({ records, problem: null }),
      (error) => gone || setFound({ records: null, problem: problemFrom(error) }),
    );
    return () => {
      gone = true;
    };
  }, [label]);
  return found;
}

async function recordsOf(label: string): Promise<readonly PersonRecord[]> {
  const jobs = await jobsOf(label);
  return Promise.all(jobs.map((each, place) => measured(each, place < MOST_COMPARED)));
}

type Known = Pick<PersonRecord, "kind" | "job">;

async function jobsOf(label: string): Promise<readonly Known[]> {
  const [fits, scans] = await Promise.all([listFits(label), listScans(label)]);
  const all: Known[] = [...fits.map((job) => ({ kind: "fit" as const, job })), ...scans.map((job) => ({ kind: "scan" as const, job }))];
  return all.sort((one, other) => other.job.created_at.localeCompare(one.job.created_at));
}

async function measured({ kind, job }: Known, isCompared: boolean): Promise<PersonRecord> {
  if (!isCompared || job.state !== "succeeded") return { kind, job, measurements: [], gender: null };
  const { measurements, gender } = kind === "scan" ? await getScanResult(job as Scan) : await getResult(job as Job);
  return { kind, job, measurements, gender };
}

/** Erase all there is of a person by now, on the service and in this browser's list. */
export async function erasePerson(label: string): Promise<void> {
  for (const { kind, job } of await jobsOf(label)) {
    await (kind === "scan" ? eraseScan : eraseFit)(job.id);
    forget(job.id);
  }
}
