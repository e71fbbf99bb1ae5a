// What there is to say of what was made: warnings, shares, combined measurements.
import { useEffect, useState } from "preact/hooks";
import { getDerivationResult } from "../api/calls";
import type { CombinedResult, Derivation, DerivationResult } from "../api/types";
import { person } from "../draft/draft";
import { entries } from "../history/store";
import { measureLabel, shown } from "../result/reading";

export function DerivationSummary({ made }: { made: Derivation }) {
  const result = useResultOf(made);
  if (result === null) return null;
  const warnings = "warnings" in result ? result.warnings : [];
  const words = inWords(result);
  return (
    <>
      {warnings.map(({ code, message }) => (
        <p class="note" key={code + message}>
          {withNames(message)}
        </p>
      ))}
      {words && <p class="fine">{words}</p>}
      {result.kind === "combined" && <Combined result={result} />}
    </>
  );
}

/** The result of a derivation that has succeeded; null until it is there. */
function useResultOf(made: Derivation): DerivationResult | null {
  const [result, setResult] = useState<DerivationResult | null>(null);
  useEffect(() => {
    let gone = false;
    getDerivationResult(made).then(
      (found) => gone || setResult(found),
      () => undefined,
    );
    return () => {
      gone = true;
    };
  }, [made.id]);
  return result;
}

function inWords(result: DerivationResult): string | null {
  if (result.kind === "animation") {
    const seconds = (result.frames * result.frame_time_s).toFixed(1);
    return `By ${result.source}: ${seconds} s, ${result.travelled_m.toFixed(1)} m of way.`;
  }
  if (result.kind === "texture") {
    const { seen_share: seen, mirrored_share: mirrored } = result;
    return `${percent(seen)} of the body was seen, ${percent(mirrored)} is mirrored, ${percent(1 - seen - mirrored)} continued.`;
  }
  if (result.kind === "combined") {
    return `From ${result.pictures} pictures. Fits of one person differ by as much as these in ${percent(result.agreement)} of cases.`;
  }
  return null;
}

function percent(share: number): string {
  return share > 0 && share < 0.005 ? "less than 1 %" : `${Math.round(100 * share)} %`;
}

/** Fits by the names this browser knows them by. */
function withNames(message: string): string {
  return entries.value.reduce((text, { id, name }) => text.replaceAll(id, `“${name}”`), message);
}

function Combined({ result }: { result: CombinedResult }) {
  const { units } = person.value;
  return (
    <table class="measures">
      <caption class="unseen">Measurements of the combined body</caption>
      <thead>
        <tr>
          <th scope="col">Measure</th>
          <th scope="col" class="number">
            Value
          </th>
          <th scope="col" class="number">
            95 % interval
          </th>
        </tr>
      </thead>
      <tbody>
        {result.measurements.map((measurement) => {
          const { value, unit, interval } = shown(measurement, units);
          return (
            <tr key={measurement.name}>
              <th scope="row" title={measurement.definition}>
                {measureLabel(measurement.name)}
              </th>
              <td class="number">
                {value} <small>{unit}</small>
              </td>
              <td class="number interval">{interval ?? (measurement.given ? "given" : "–")}</td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
