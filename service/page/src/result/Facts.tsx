// How the fit went, what was found, and what had to be assumed.
import { getAsked } from "../api/calls";
import type { Fit, FittedView, Result } from "../api/fits";
import { termLabel } from "../fit/stages";
import { proposedText } from "../measure/proposed";
import { decimal, seconds } from "../messages/figures";
import { messages } from "../messages/language";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { useAsked } from "../ui/asked";
import { OfPicture } from "./OfPicture";
import { WarningNotes } from "./WarningNotes";
import { qualityOf } from "./grade";

export interface FactsProps {
  readonly fit: Fit;
  readonly result: Result;
  /** Say which way these limbs slant in a picture; null until it is there. */
  readonly onSayWhich: ((limbs: readonly string[], number: number) => void) | null;
}

export function Facts({ fit, result, onSayWhich }: FactsProps) {
  const asked = useAsked(fit.id, () => getAsked(fit));
  const { views } = result;
  const { grade, text, agreement } = qualityOf(result);
  const isOfSeveral = views.length > 1;
  const proposed = isOfSeveral && asked && proposedText(views, asked);
  return (
    <>
      <p class={`quality is-${grade}`} data-grade={grade}>
        {text}
      </p>
      {agreement && <p class="fine">{agreement}</p>}
      <p class="fine">{messages.value.result.foundBy[result.cues]}</p>
      <WarningNotes warnings={withoutFound(result)} views={views} />
      {proposed && <p class="fine">{proposed}</p>}
      <AssumptionNotes assumptions={result.assumptions} asked={null} />
      {!isOfSeveral && <OfPicture view={views[0]!} views={views} asked={asked?.views[0]?.points ?? null} onSayWhich={onSayWhich} />}
      <ForExperts result={result} />
    </>
  );
}

/** What a check of a picture found is told with the picture, and what to do about it. */
function withoutFound({ warnings, views }: Result): Result["warnings"] {
  const found = new Set(views.flatMap(({ findings }: FittedView) => findings.map(({ code }) => code as string)));
  return warnings.filter(({ code }) => !found.has(code));
}

function ForExperts({ result: { energies, evaluations, stage_seconds } }: { result: Result }) {
  const { result: words } = messages.value;
  // Earlier versions kept none of scans.
  if (evaluations === 0) return null;
  return (
    <details class="fold">
      <summary>{words.expert}</summary>
      <dl class="facts">
        {Object.entries(energies).map(([name, value]) => (
          <>
            <dt>{termLabel(name)}</dt>
            <dd>{decimal(value, 1)}</dd>
          </>
        ))}
        <dt>{words.evaluations}</dt>
        <dd>{decimal(evaluations)}</dd>
        <dt>{words.time}</dt>
        <dd>{seconds(Object.values(stage_seconds).reduce((sum, each) => sum + each, 0), 1)}</dd>
      </dl>
    </details>
  );
}
