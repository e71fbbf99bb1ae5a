// What the service keeps of a person: fits, each with what it measured.
import { useEffect, useState } from "preact/hooks";
import { eraseFit, getResult, listFits } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Fit } from "../api/fits";
import type { Measurement, Problem } from "../api/types";
import { forget } from "../history/store";

export interface PersonRecord {
  readonly fit: Fit;
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
  const fits = await listFits(label);
  return Promise.all(fits.map((each, place) => measured(each, place < MOST_COMPARED)));
}

async function measured(fit: Fit, isCompared: boolean): Promise<PersonRecord> {
  if (!isCompared || fit.state !== "succeeded") return { fit, measurements: [], gender: null };
  const { measurements, gender } = await getResult(fit);
  return { fit, measurements, gender };
}

/** Erase all there is of a person by now, on the service and in this browser's list. */
export async function erasePerson(label: string): Promise<void> {
  for (const fit of await listFits(label)) {
    await eraseFit(fit);
    forget(fit.id);
  }
}
