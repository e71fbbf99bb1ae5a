// Where a fit is prepared: the picture on the left, what is known on the right. On phones all is below one another, the
// person first: without a gender nothing follows the clicks.
import { useEffect } from "preact/hooks";
import { isAsleep, picture, points, upcoming } from "../draft/draft";
import { isRestoring } from "../draft/lasting";
import { isEditing } from "../mask/edits";
import { MaskSection } from "../mask/MaskSection";
import { MaskStage } from "../mask/MaskStage";
import { messages } from "../messages/language";
import { hasProposed } from "../points/proposed";
import { isFull } from "../stage/full";
import { Stage } from "../stage/Stage";
import { isNarrow } from "../ui/narrow";
import { EvidencePanel } from "./EvidencePanel";
import { FacingPanel } from "./FacingPanel";
import { LensPanel } from "./LensPanel";
import { LightPanel } from "./LightPanel";
import { MaskPanel } from "./MaskPanel";
import { openFile, openProblem } from "./open";
import { sizeOf } from "./size";
import { PersonPanel } from "./PersonPanel";
import { NextLine, PointsPanel } from "./PointsPanel";
import { Start } from "./Start";
import { SubmitBar } from "./SubmitBar";

export function Workbench() {
  const { panel } = messages.value;
  const shown = picture.value;
  useEffect(() => {
    if (shown) isAsleep.value = false;
  }, [shown]);
  useEffect(() => () => void (isFull.value = false), []);
  if (!shown) return isRestoring.value ? <main class="waiting" aria-busy="true" /> : <Start />;
  return (
    <main
      class="bench"
      onDragOver={(event) => event.preventDefault()}
      onDrop={(event) => {
        event.preventDefault();
        const file = event.dataTransfer?.files[0];
        if (file) void openFile(file);
      }}
    >
      <h1 class="unseen">{panel.title}</h1>
      {isNarrow.value && (
        <div class="bench-person" inert={isFull.value}>
          <PersonPanel />
        </div>
      )}
      <div class={`bench-stage ${upcoming.value ? "" : "is-settled"} ${hasProposed(points.value) ? "is-proposed" : ""} ${isFull.value ? "is-full" : ""}`}>
        {isEditing.value ? (
          <MaskStage />
        ) : (
          <>
            <NextLine />
            <Stage />
          </>
        )}
      </div>
      <div class="panel" inert={isFull.value}>
        <div class="panel-scroll">
          <section class="section is-tight" aria-label={panel.picture}>
            <div class="picture-line">
              <span class="picture-name">{shown.name}</span>
              <span class="count">
                {sizeOf(shown)}
              </span>
              <label class="link">
                {panel.replace}
                <input
                  class="unseen"
                  type="file"
                  accept="image/*"
                  aria-label={panel.another}
                  onChange={(event) => {
                    const file = event.currentTarget.files?.[0];
                    event.currentTarget.value = "";
                    if (file) void openFile(file);
                  }}
                />
              </label>
            </div>
            {shown.scaledFrom && <p class="fine">{panel.scaled(sizeOf(shown.scaledFrom))}</p>}
            {openProblem.value && (
              <p class="note is-problem" role="alert">
                {openProblem.value}
              </p>
            )}
          </section>
          {!isNarrow.value && <PersonPanel />}
          <PointsPanel />
          <MaskSection />
          <FacingPanel />
          <details class="section fold-section">
            <summary>
              <h2>{panel.lensAndLight}</h2> <span class="count">{panel.optional}</span>
            </summary>
            <LensPanel />
            <LightPanel />
          </details>
          <details class="section fold-section">
            <summary>
              <h2>{panel.evidence}</h2> <span class="count">{panel.optional}</span>
            </summary>
            <EvidencePanel />
            <MaskPanel />
          </details>
        </div>
        <SubmitBar />
      </div>
    </main>
  );
}
