// What came out of a scan: the body over its pictures, its measurements, and how far to trust them.
import { useSignal } from "@preact/signals";
import { useState } from "preact/hooks";
import { eraseScan, getScanResult } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem, Scan, ScanResult } from "../api/types";
import type { Picture } from "../draft/picture";
import { forget } from "../history/store";
import { Downloads } from "../result/Downloads";
import { useFilesOf } from "../result/files";
import { Measures } from "../result/Measures";
import { Withheld } from "../result/Withheld";
import { MEASURE_ADDRESS, go } from "../route";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { IconButton } from "../ui/IconButton";
import { ProblemNote } from "../ui/ProblemNote";
import { Findings } from "./Findings";
import { qualityOf } from "./quality";
import { ScanLook } from "./ScanLook";
import type { Shown } from "./ScanLook";
import { measureByForce, reopen } from "./send";

export function ScanResultView({ scan, pictures }: { scan: Scan; pictures: readonly Picture[] }) {
  const { files, problem } = useFilesOf(scan, () => getScanResult(scan), "body_posed_0.glb");
  const [pointedAt, pointAt] = useState<string | null>(null);
  const [marked, mark] = useState<string | null>(null);
  const [shown, show] = useState<Shown>("pictures");
  const [front] = pictures;
  if (problem) {
    return (
      <main class="ended">
        <h1>The result cannot be shown</h1>
        <ProblemNote problem={problem} />
      </main>
    );
  }
  return (
    <main class="bench is-scan" aria-busy={files === null} data-scan={scan.id}>
      <div class="bench-stage">
        {files && front && (
          <ScanLook scan={scan} files={files} picture={front} shown={shown} onShow={show} measure={pointedAt ?? marked} />
        )}
      </div>
      <div class="panel">
        <div class="panel-scroll">
          <section class="section">
            <h1 class="title">The body</h1>
            {files && <Quality result={files.result} />}
          </section>
          {files && files.result.measurements.length === 0 && <Withheld onAnyway={() => measureByForce(scan)} />}
          {files && files.result.measurements.length > 0 && (
            <Measures
              measurements={files.result.measurements}
              before={null}
              pointedAt={pointedAt ?? marked}
              onPoint={pointAt}
              onShow={(name) => {
                mark(marked === name ? null : name);
                show("upright");
              }}
            />
          )}
          {files && <OfPictures result={files.result} />}
          {files && <Downloads job={scan} result={files.result} />}
        </div>
        <Actions scan={scan} />
      </div>
    </main>
  );
}

function Quality({ result }: { result: ScanResult }) {
  const { text, isBad } = qualityOf(result);
  return (
    <>
      <p class={isBad ? "note is-problem" : "quality"}>{text}</p>
      {result.warnings.map(({ code, message }) => (
        <p class="note" key={code + message}>
          {message.replaceAll("_", " ")}
        </p>
      ))}
      <AssumptionNotes assumptions={result.assumptions} />
    </>
  );
}

/** What there is to say of each picture; nothing of one that is good. */
function OfPictures({ result }: { result: ScanResult }) {
  return (
    <>
      {result.views.map(({ number, view, findings, warnings, assumptions, verdict, outcome_explanation }) => {
        const silent = findings.length + warnings.length + assumptions.length === 0 && verdict === "plausible";
        if (silent) return null;
        return (
          <section class="section" key={number} aria-labelledby={`of-${number}`}>
            <h2 id={`of-${number}`}>{`The ${view} picture`}</h2>
            {verdict !== "plausible" && <p class="note is-problem">{outcome_explanation}</p>}
            <Findings findings={findings} />
            {warnings.map(({ code, message }) => (
              <p class="note" key={code + message}>
                {message.replaceAll("_", " ")}
              </p>
            ))}
            <AssumptionNotes assumptions={assumptions} />
          </section>
        );
      })}
    </>
  );
}

function Actions({ scan }: { scan: Scan }) {
  const problem = useSignal<Problem | null>(null);
  const asks = useSignal(false);
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
      {asks.value ? (
        <div class="submit-row" role="group" aria-label="Delete this scan?">
          <span class="grow">Erase this scan with its pictures?</span>
          <button class="button" type="button" onClick={() => (asks.value = false)}>
            Keep
          </button>
          <button class="button is-danger" type="button" onClick={() => void attempt(erase)}>
            Delete
          </button>
        </div>
      ) : (
        <div class="submit-row">
          <button class="button is-primary grow" type="button" onClick={() => void attempt(() => reopen(scan, null))}>
            Change and measure again
          </button>
          <IconButton icon="trash" label="Delete this scan" onClick={() => (asks.value = true)} />
        </div>
      )}
    </div>
  );
}
