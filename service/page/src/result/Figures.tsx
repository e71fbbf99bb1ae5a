// The four figures most people ask for, with their ranges.
import type { Measurement } from "../api/types";
import { person } from "../draft/draft";
import { messages } from "../messages";
import { shown } from "./reading";

const FIGURES = ["chest_girth", "waist_girth_smallest", "hip_girth", "weight"] as const;
const LEFT_OUT = { value: "–", unit: "", interval: null };

interface Props {
  readonly measurements: readonly Measurement[];
  /** Whether the body they are of fits its picture. */
  readonly reliable: boolean;
}

export function Figures({ measurements, reliable }: Props) {
  const { figures, given, tooWide } = messages.result;
  const { units } = person.value;
  return (
    <dl class={reliable ? "figures" : "figures is-unreliable"}>
      {FIGURES.map((name) => {
        const found = measurements.find((each) => each.name === name);
        const { value, unit, interval } = found ? shown(found, units) : LEFT_OUT;
        return (
          <div key={name}>
            <dt>{figures[name]}</dt>
            <dd>
              <b>{value}</b> <small>{unit}</small>
            </dd>
            <dd class="figure-range">{found ? (interval ?? (found.given ? given : "")) : tooWide}</dd>
          </div>
        );
      })}
    </dl>
  );
}
