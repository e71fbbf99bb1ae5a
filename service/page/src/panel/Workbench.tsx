// Where a fit is prepared: the picture on the left, what is known on the right.
import { picture, points, upcoming } from "../draft/draft";
import { hasProposed } from "../points/proposed";
import { Stage } from "../stage/Stage";
import { EvidencePanel } from "./EvidencePanel";
import { FacingPanel } from "./FacingPanel";
import { LensPanel } from "./LensPanel";
import { LightPanel } from "./LightPanel";
import { MaskPanel } from "./MaskPanel";
import { openFile, openProblem } from "./open";
import { PersonPanel } from "./PersonPanel";
import { NextLine, PointsPanel } from "./PointsPanel";
import { Start } from "./Start";
import { SubmitBar } from "./SubmitBar";

export function Workbench() {
  const shown = picture.value;
  if (!shown) return <Start />;
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
      <h1 class="unseen">Prepare a fit</h1>
      <div class={`bench-stage ${upcoming.value ? "" : "is-settled"} ${hasProposed(points.value) ? "is-proposed" : ""}`}>
        <NextLine />
        <Stage />
      </div>
      <div class="panel">
        <div class="panel-scroll">
          <section class="section is-tight" aria-label="Picture">
            <div class="picture-line">
              <span class="picture-name">{shown.name}</span>
              <span class="count">
                {shown.width} × {shown.height}
              </span>
              <label class="link">
                Replace
                <input
                  class="unseen"
                  type="file"
                  accept="image/*"
                  aria-label="Choose another picture"
                  onChange={(event) => {
                    const file = event.currentTarget.files?.[0];
                    event.currentTarget.value = "";
                    if (file) void openFile(file);
                  }}
                />
              </label>
            </div>
            {openProblem.value && (
              <p class="note is-problem" role="alert">
                {openProblem.value}
              </p>
            )}
          </section>
          <PersonPanel />
          <PointsPanel />
          <FacingPanel />
          <details class="section fold-section">
            <summary>
              <h2>Lens and light</h2> <span class="count">optional</span>
            </summary>
            <LensPanel />
            <LightPanel />
          </details>
          <details class="section fold-section">
            <summary>
              <h2>What the fit goes by</h2> <span class="count">optional</span>
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
