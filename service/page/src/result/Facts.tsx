// What is in doubt, what to do about it, and what had to be assumed; for experts, how the fit went.
import { getAsked } from "../api/calls";
import type { Fit, FittedView, Result } from "../api/fits";
import { termLabel } from "../fit/stages";
import { proposedText } from "../measure/proposed";
import { viewTitles } from "../measure/views";
import { decimal, seconds } from "../messages/figures";
import { messages } from "../messages";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { useAsked } from "../ui/asked";
import { OfPicture, PictureFacts } from "./OfPicture";
import { WarningNotes } from "./WarningNotes";
import { adviceOf } from "./advice";
import { qualityOf } from "./grade";

export interface FactsProps {
  readonly fit: Fit;
  readonly result: Result;
  /** Say which way these limbs slant in a picture; null until it is there. */
  readonly onSayWhich: ((limbs: readonly string[], number: number) => void) | null;
  /** Correct the points of a picture; null until it is there, and where they cannot be. */
  readonly onCorrect: ((number: number) => void) | null;
}

export function Quality({ result }: Pick<FactsProps, "result">) {
  const { grade, text } = qualityOf(result);
  return (
    <p class={`quality is-${grade}`} data-grade={grade}>
      {text}
    </p>
  );
}

export function Facts({ fit, result, onSayWhich, onCorrect }: FactsProps) {
  const asked = useAsked(fit.id, () => getAsked(fit));
  const { views } = result;
  const isOfSeveral = views.length > 1;
  const proposed = isOfSeveral && asked && proposedText(views, asked);
  return (
    <div class="section notes">
      <AdviceNote result={result} onCorrect={onCorrect} />
      <WarningNotes warnings={withoutFound(result)} views={views} />
      {!isOfSeveral && <OfPicture view={views[0]!} views={views} asked={asked?.views[0]?.points ?? null} onSayWhich={onSayWhich} />}
      {proposed && <p class="fine">{proposed}</p>}
      <AssumptionNotes assumptions={result.assumptions} asked={null} />
    </div>
  );
}

function AdviceNote({ result, onCorrect }: Pick<FactsProps, "result" | "onCorrect">) {
  const { result: words } = messages;
  const advice = adviceOf(result);
  if (!advice) return null;
  return (
    <p class="note is-advice" data-advice={advice}>
      <b>{words.helpsMost}</b> {words.advice[advice]}{" "}
      {onCorrect && (
        <button class="link" type="button" onClick={() => onCorrect(0)}>
          {words.correctIt}
        </button>
      )}
    </p>
  );
}

/** What a check of a picture found is told with the picture, and what to do about it. */
function withoutFound({ warnings, views }: Result): Result["warnings"] {
  const found = new Set(views.flatMap(({ findings }: FittedView) => findings.map(({ code }) => code as string)));
  return warnings.filter(({ code }) => !found.has(code));
}

export function ForExperts({ result }: Pick<FactsProps, "result">) {
  const { cues, energies, evaluations, stage_seconds, views } = result;
  const { agreement } = qualityOf(result);
  const { result: words } = messages;
  const titles = viewTitles(views);
  return (
    <details class="section fold-section experts">
      <summary>
        <h2>{words.expert}</h2>
      </summary>
      <p class="fine">{words.foundBy[cues]}</p>
      {agreement && <p class="fine">{agreement}</p>}
      {views.map((view) => (
        <>
          {views.length > 1 && <h3>{titles[view.number]}</h3>}
          <PictureFacts view={view} />
        </>
      ))}
      {/* Earlier versions kept none of scans. */}
      {evaluations > 0 && (
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
      )}
    </details>
  );
}
