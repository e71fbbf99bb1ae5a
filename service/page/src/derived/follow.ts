// What is made of a fit, each followed to its end.
import { useEffect, useState } from "preact/hooks";
import { derive, eraseDerivation, getDerivation, listDerivations, retryDerivation } from "../api/calls";
import { problemFrom } from "../api/client";
import { jobEvents } from "../api/events";
import type { Fit } from "../api/fits";
import type { Derivation, DerivationRequest, Problem } from "../api/types";
import { isActive } from "../fit/watch";
import type { Part } from "./kinds/kind";

export interface Derived {
  /** Newest first. */
  readonly list: readonly Derivation[];
  readonly problem: Problem | null;
  /** With the file that comes along, if any. */
  readonly start: (asked: DerivationRequest, part: Part | null) => Promise<void>;
  /** As `start`, but over once it has ended. */
  readonly make: (asked: DerivationRequest) => Promise<void>;
  readonly retry: (each: Derivation) => Promise<void>;
  readonly erase: (each: Derivation) => Promise<void>;
}

/** `onMade` hears of what was asked for here, once it has succeeded. */
export function useDerivations(parent: Fit, onMade: (made: Derivation) => void): Derived {
  const [list, setList] = useState<readonly Derivation[]>([]);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [leaving] = useState(() => new AbortController());
  const fail = (error: unknown) => !leaving.signal.aborted && setProblem(problemFrom(error));
  const put = (seen: Derivation) =>
    setList((old) => (old.some(({ id }) => id === seen.id) ? old.map((each) => (each.id === seen.id ? seen : each)) : [seen, ...old]));

  const follow = async (each: Derivation) => {
    for await (const { state, stage, progress } of jobEvents(each.links.events, leaving.signal)) {
      if (isActive({ state })) put({ ...each, state, stage, progress });
    }
    const ended = await getDerivation(each.links.self);
    put(ended);
    return ended;
  };

  const begin = (begun: Derivation) => {
    put(begun);
    follow(begun).then((ended) => ended.state === "succeeded" && onMade(ended), fail);
  };

  useEffect(() => {
    listDerivations(parent).then((found) => {
      setList(found);
      for (const each of found) if (isActive(each)) follow(each).catch(fail);
    }, fail);
    return () => leaving.abort();
  }, []);

  const attempt = async (what: () => Promise<void>) => {
    setProblem(null);
    await what().catch(fail);
  };
  return {
    list,
    problem,
    start: (asked, part) => attempt(async () => begin(await derive(parent, asked, part))),
    make: (asked) =>
      attempt(async () => {
        const begun = await derive(parent, asked, null);
        put(begun);
        const ended = await follow(begun);
        if (ended.state === "succeeded") onMade(ended);
      }),
    retry: (each) => attempt(async () => begin(await retryDerivation(each))),
    erase: (each) =>
      attempt(async () => {
        await eraseDerivation(each);
        setList((old) => old.filter(({ id }) => id !== each.id));
      }),
  };
}
