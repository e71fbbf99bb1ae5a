// What changed between two records, as the service tells it; asked for once, and found again later.
import { useEffect, useState } from "preact/hooks";
import { derive, getDerivation, getDerivationResult, listDerivations } from "../api/calls";
import { problemFrom } from "../api/client";
import { jobEvents } from "../api/events";
import type { ChangeResult, Derivation, Problem } from "../api/types";
import { isActive } from "../fit/watch";
import { COMPARED } from "./chosen";
import type { PersonRecord } from "./records";

interface Told {
  readonly result: ChangeResult | null;
  readonly problem: Problem | null;
}

/** Records that the newest one can be compared with, newest first: the service compares like with like. */
export function comparable(records: readonly PersonRecord[]): readonly PersonRecord[] {
  const measured = records.filter(({ measurements }) => measurements.length > 0);
  const groups = measured.map((newest, place) => measured.slice(place).filter(({ fit, gender }) => fit.kind === newest.fit.kind && gender === newest.gender));
  return groups.find((group) => group.length > 1) ?? [];
}

export function useChange(after: PersonRecord, before: PersonRecord): Told {
  const [told, setTold] = useState<Told>({ result: null, problem: null });
  useEffect(() => {
    const leaving = new AbortController();
    setTold({ result: null, problem: null });
    changeOf(after, before, leaving.signal).then(
      (result) => leaving.signal.aborted || setTold({ result, problem: null }),
      (error) => leaving.signal.aborted || setTold({ result: null, problem: problemFrom(error) }),
    );
    return () => leaving.abort();
  }, [after.fit.id, before.fit.id]);
  return told;
}

async function changeOf(after: PersonRecord, before: PersonRecord, signal: AbortSignal): Promise<ChangeResult | null> {
  const made = (await listDerivations(after.fit)).filter(({ kind, state }) => kind === "change" && state === "succeeded");
  for (const each of made) {
    const result = await resultOf(each);
    if (result?.since === before.fit.id && isOfCompared(result)) return result;
  }
  const asked = { kind: "change" as const, since: before.fit.id, measurements: [...COMPARED] };
  return resultOf(await ended(await derive(after.fit, asked, null), signal));
}

async function ended(begun: Derivation, signal: AbortSignal): Promise<Derivation> {
  for await (const { state } of jobEvents(begun.links.events, signal)) if (!isActive({ state })) break;
  return getDerivation(begun.links.self);
}

async function resultOf(made: Derivation): Promise<ChangeResult | null> {
  if (made.state !== "succeeded") return null;
  const result = await getDerivationResult(made);
  return result.kind === "change" ? result : null;
}

function isOfCompared({ changes }: ChangeResult): boolean {
  return changes.length === COMPARED.length && COMPARED.every((name) => changes.some((each) => each.name === name));
}
