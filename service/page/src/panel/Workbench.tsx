// Where a fit is prepared: the pictures, who is in them, one button; all else is behind "Adjust".
import { useEffect } from "preact/hooks";
import { current, isCorrecting, points, upcoming } from "../draft/draft";
import { liveProblem } from "../draft/live";
import { openFiles, openProblem, replaceFile } from "../draft/open";
import { isNobody, isProposing, proposal } from "../draft/proposing";
import { isEditing } from "../mask/edits";
import { messages } from "../messages";
import { isEnough } from "../points/placed";
import { hasProposed } from "../points/proposed";
import { isFull } from "../stage/full";
import { Stage } from "../stage/Stage";
import { Start } from "../start/Start";
import { Findings } from "../ui/Findings";
import { FileButton } from "../ui/FileButton";
import { ProblemNote } from "../ui/ProblemNote";
import { later } from "../ui/later";
import { isNarrow } from "../ui/narrow";
import { PersonPanel } from "./PersonPanel";
import { Pictures } from "./Pictures";
import { SubmitBar } from "./SubmitBar";

const Corrections = later(() => import("./Corrections").then((loaded) => loaded.Corrections), null);
const NextLine = later(() => import("./PointsPanel").then((loaded) => loaded.NextLine), null);
const MaskStage = later(() => import("../mask/MaskStage").then((loaded) => loaded.MaskStage), null);

export function Workbench() {
  const { panel } = messages;
  const view = current.value;
  // Nobody proposes them: they are clicked.
  const hasToClick = view !== null && !isProposing.value && !isNobody.value && !isEnough(points.value);
  useEffect(() => {
    if (hasToClick) isCorrecting.value = true;
  }, [hasToClick]);
  useEffect(() => () => void (isFull.value = false), []);
  if (!view) return <Start />;
  const corrects = isCorrecting.value;
  const look = ["bench-stage", upcoming.value ? "" : "is-settled", hasProposed(points.value) ? "is-proposed" : "", isFull.value ? "is-full" : "", corrects ? "" : "is-plain"];
  const problem = view.problem.value ?? liveProblem.value;
  return (
    <main
      class="bench"
      onDragOver={(event) => event.preventDefault()}
      onDrop={(event) => {
        event.preventDefault();
        const files = [...(event.dataTransfer?.files ?? [])];
        if (files.length > 0) void openFiles(files);
      }}
    >
      <h1 class="unseen">{panel.title}</h1>
      {isNarrow.value && (
        <div class="bench-person" inert={isFull.value}>
          <PersonPanel />
        </div>
      )}
      <div class={look.join(" ")}>
        <Pictures />
        {isEditing.value ? (
          <MaskStage />
        ) : (
          <>
            {corrects && <NextLine />}
            <Stage key={view.picture.url} />
          </>
        )}
      </div>
      <div class="panel" inert={isFull.value}>
        <div class="panel-scroll">
          {openProblem.value && (
            <div class="section is-tight">
              <p class="note is-problem" role="alert">
                {openProblem.value}
              </p>
            </div>
          )}
          {!isNarrow.value && <PersonPanel />}
          <Notes problem={problem} />
          <details class="corrections" open={corrects} onToggle={({ currentTarget }) => (isCorrecting.value = currentTarget.open)}>
            <summary>
              <h2>{panel.correct}</h2> <span class="count">{panel.correctWhat}</span>
            </summary>
            {corrects && <Corrections />}
          </details>
        </div>
        {isNobody.value && !corrects ? <Nobody /> : <SubmitBar />}
      </div>
    </main>
  );
}

/** In place of the button: there is nobody to measure yet. */
function Nobody() {
  const { panel } = messages;
  return (
    <div class="submit">
      <div class="submit-row is-choice">
        <FileButton look="button is-primary" onChoose={([file]) => void replaceFile(file!)}>
          {panel.another}
        </FileButton>
        <button
          class="button"
          type="button"
          onClick={() => {
            isCorrecting.value = true;
            // The button is gone: keys go on at the picture.
            document.querySelector<HTMLElement>(".stage")?.focus({ preventScroll: true });
          }}
        >
          {panel.proposal.clickAll}
        </button>
      </div>
    </div>
  );
}

/** What the service says of the picture that is looked at. */
function Notes({ problem }: { problem: Parameters<typeof ProblemNote>[0]["problem"] | null }) {
  const findings = proposal.value?.findings ?? [];
  if (!problem && findings.length === 0) return null;
  return (
    <div class="section is-tight">
      {problem && <ProblemNote problem={problem} />}
      <Findings findings={findings} />
    </div>
  );
}
