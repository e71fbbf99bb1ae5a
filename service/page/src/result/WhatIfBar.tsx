// Another weight or waist tried on the upright body, and what would follow.
import { useEffect, useState } from "preact/hooks";
import { problemFrom } from "../api/client";
import type { FitResult, Measurement, Problem } from "../api/types";
import { person } from "../draft/draft";
import { listed } from "../messages/figures";
import { messages } from "../messages";
import { ProblemNote } from "../ui/ProblemNote";
import { Slider } from "../ui/Slider";
import type { GlbBody } from "../viewer/glb";
import { shown } from "./reading";
import { CHANGED, FOLLOWING, changed } from "./whatIf";
import type { Change, Changed } from "./whatIf";

/** To either side, kilograms and centimetres. */
const RANGE = { least: -5, most: 5, step: 0.5 } as const;
const PAUSE_MS = 120;
const NOTHING: Change = {};

interface Props {
  readonly result: FitResult;
  readonly upright: GlbBody;
  /** Null for the body as it was measured. */
  readonly onBody: (body: GlbBody | null) => void;
}

export function WhatIfBar({ result, upright, onBody }: Props) {
  const { figures, whatIf: words } = messages.result;
  const { units } = person.value;
  const [change, setChange] = useState(NOTHING);
  const [found, setFound] = useState<Changed | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  useEffect(() => {
    const show = (next: Changed | null) => {
      setFound(next);
      setProblem(null);
      onBody(next?.body ?? null);
    };
    if (change === NOTHING) return show(null);
    const leaving = new AbortController();
    const timer = setTimeout(() => changed(result, upright, change, leaving.signal).then(show, (error) => setProblem(problemFrom(error))), PAUSE_MS);
    return () => {
      clearTimeout(timer);
      leaving.abort();
    };
  }, [change]);
  useEffect(() => () => onBody(null), []);
  const told = (each: Measurement) => {
    const { value, unit } = shown(each, units);
    return `${value} ${unit}`;
  };
  return (
    <details class="what-if" onToggle={({ currentTarget }) => currentTarget.open || setChange(NOTHING)}>
      <summary>{words.title}</summary>
      <div class="look-bar">
        {CHANGED.flatMap((name) => {
          const own = named(result.measurements, name);
          // What was not chosen follows what was.
          const by = change[name] ?? (found && own ? named(found.measurements, name)!.value - own.value : 0);
          return own
            ? [<Slider key={name} label={figures[name]} range={RANGE} value={by} text={told({ ...own, value: own.value + by })} onInput={(next) => setChange({ ...change, [name]: next })} />]
            : [];
        })}
        {found && (
          <p class="fine" role="status">
            {words.would(listed(FOLLOWING.flatMap((name) => {
              const each = named(found.measurements, name);
              return each ? [`${figures[name]} ${told(each)}`] : [];
            })))}
          </p>
        )}
        {problem && <ProblemNote problem={problem} />}
        {change !== NOTHING && (
          <button class="button is-small" type="button" onClick={() => setChange(NOTHING)}>
            {words.back}
          </button>
        )}
      </div>
    </details>
  );
}

function named(measurements: readonly Measurement[], name: string): Measurement | undefined {
  return measurements.find((each) => each.name === name);
}
