// What came out of a scan: the body over its pictures, its measurements, and how far to trust them.
import { useSignal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import { eraseScan, getScanRequest, getScanResult } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem, Scan, ScanResult } from "../api/types";
import type { Picture } from "../draft/picture";
import { forget } from "../history/store";
import { messages } from "../messages/language";
import { Downloads } from "../result/Downloads";
import { useFilesOf } from "../result/files";
import { Measures, rowOf } from "../result/Measures";
import { Withheld } from "../result/Withheld";
import { MEASURE_ADDRESS, go } from "../route";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { useEscape } from "../ui/escape";
import { IconButton } from "../ui/IconButton";
import { ProblemNote } from "../ui/ProblemNote";
import { useQuestion } from "../ui/question";
import { Served } from "../ui/Served";
import { useAsked } from "../ui/asked";
import { PROPOSED_POINTS } from "../ui/proposed";
import { DerivedPanel } from "../derived/DerivedPanelLater";
import { Findings } from "./Findings";
import { plainly } from "./plainly";
import { proposedText } from "./proposed";
import { qualityOf } from "./quality";
import { ScanLook } from "./ScanLook";
import type { Shown } from "./ScanLook";
import { ScanWarnings } from "./ScanWarnings";
import { measureByForce, reopen } from "./send";
import { pictureOf } from "./views";

/** What is offered to be made of a scan. */
const OF_SCANS = ["report", "size"] as const;

export function ScanResultView({ scan, pictures }: { scan: Scan; pictures: readonly Picture[] }) {
  const { result: words } = messages.value;
  const { result, files, loaded, problem } = useFilesOf(scan, () => getScanResult(scan), "body_posed_0.glb");
  const [pointedAt, pointAt] = useState<string | null>(null);
  const [marked, mark] = useState<string | null>(null);
  const [shown, show] = useState<Shown>("pictures");
  const stage = useRef<HTMLDivElement>(null);
  // On a phone the body lies above the table, out of sight of whoever taps a row.
  useEffect(() => {
    if (marked !== null) stage.current?.scrollIntoView({ block: "nearest" });
  }, [marked]);
  useEscape([[marked !== null, () => mark(null)]]);
  if (problem) {
    return (
      <main class="ended">
        <h1>{words.notShown}</h1>
        <ProblemNote problem={problem} />
      </main>
    );
  }
  return (
    <main class="bench is-scan" aria-busy={files === null} data-scan={scan.id}>
      <div class="bench-stage" ref={stage}>
        {result && (
          <ScanLook
            scan={scan}
            result={result}
            files={files}
            loaded={loaded}
            pictures={pictures}
            shown={shown}
            onShow={show}
            measure={pointedAt ?? marked}
            onPoint={pointAt}
            onMeasure={(name) => {
              mark(marked === name ? null : name);
              document.getElementById(rowOf(name))?.scrollIntoView({ block: "center" });
            }}
          />
        )}
      </div>
      <div class="panel">
        <div class="panel-scroll">
          <section class="section">
            <h1 class="title">{words.body}</h1>
            {result ? <Quality scan={scan} result={result} /> : <p class="fine">{words.loading}</p>}
          </section>
          {result && <OfPictures result={result} />}
          {result && result.measurements.length === 0 && <Withheld onAnyway={() => measureByForce(scan)} />}
          {result && result.measurements.length > 0 && (
            <Measures
              measurements={result.measurements}
              before={null}
              pointedAt={pointedAt ?? marked}
              onPoint={pointAt}
              onShow={(name) => {
                mark(marked === name ? null : name);
                show("upright");
              }}
            />
          )}
          {result && <DerivedPanel parent={scan} kinds={OF_SCANS} hasLight={false} />}
          {result && <Downloads job={scan} result={result} />}
        </div>
        <Actions scan={scan} />
      </div>
    </main>
  );
}

function Quality({ scan, result }: { scan: Scan; result: ScanResult }) {
  const asked = useAsked(scan.id, () => getScanRequest(scan));
  const { text, isBad, agreement } = qualityOf(result);
  // Told with its picture, and what to do about it.
  const found = new Set(result.views.flatMap(({ findings }) => findings.map(({ code }) => code as string)));
  const warnings = result.warnings.filter(({ code }) => !found.has(code));
  const proposed = asked && proposedText(result.views, asked);
  return (
    <>
      <p class={isBad ? "note is-problem" : "quality"}>{text}</p>
      {agreement && <p class="fine">{agreement}</p>}
      <ScanWarnings warnings={warnings} views={result.views} />
      {proposed && <p class="fine">{proposed}</p>}
      <AssumptionNotes assumptions={result.assumptions} asked={null} />
    </>
  );
}

/** What there is to say of each picture; nothing of one that is good. */
function OfPictures({ result }: { result: ScanResult }) {
  return (
    <>
      {result.views.map(({ number, view, findings, warnings, assumptions: all, verdict, outcome_explanation }) => {
        const assumptions = all.filter(({ quantity }) => quantity !== PROPOSED_POINTS);
        const silent = findings.length + warnings.length + assumptions.length === 0 && verdict === "plausible";
        if (silent) return null;
        return (
          <section class="section" key={number} aria-labelledby={`of-${number}`}>
            <h2 id={`of-${number}`}>{messages.value.measure.ofPicture(pictureOf(view))}</h2>
            {verdict !== "plausible" && <p class="note is-problem">{plainly("verdicts", verdict) ?? <Served text={outcome_explanation} />}</p>}
            <Findings findings={findings} />
            <ScanWarnings warnings={warnings} views={result.views} />
            <AssumptionNotes assumptions={assumptions} asked={null} />
          </section>
        );
      })}
    </>
  );
}

function Actions({ scan }: { scan: Scan }) {
  const { measure: { result: words }, result } = messages.value;
  const problem = useSignal<Problem | null>(null);
  const question = useQuestion();
  const attempt = async (what: () => Promise<void>) => {
    try {
      await what();
      problem.value = null;
    } catch (error) {
      problem.value = problemFrom(error);
    }
  };
  const erase = async () => {
    await eraseScan(scan.id);
    forget(scan.id);
    go(MEASURE_ADDRESS);
  };
  return (
    <div class="submit">
      {problem.value && <ProblemNote problem={problem.value} />}
      {question.isAsked ? (
        <div class="submit-row" role="group" aria-label={words.deleteQuestion}>
          <span class="grow">{words.erase}</span>
          <button class="button" type="button" ref={question.refusal} onClick={question.leave}>
            {result.keep}
          </button>
          <button class="button is-danger" type="button" onClick={() => void attempt(erase)}>
            {result.delete}
          </button>
        </div>
      ) : (
        <div class="submit-row">
          <button class="button is-primary grow" type="button" onClick={() => void attempt(() => reopen(scan, null))}>
            {words.change}
          </button>
          <IconButton icon="trash" label={words.delete} onClick={question.ask} buttonRef={question.asker} />
        </div>
      )}
    </div>
  );
}
