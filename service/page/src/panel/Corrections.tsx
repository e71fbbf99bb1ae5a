// All that can be corrected before a fit: the picture, its points, the mask, limbs, the lens and the light.
import { picture } from "../draft/draft";
import { MaskSection } from "../mask/MaskSection";
import { messages } from "../messages";
import { EvidencePanel } from "./EvidencePanel";
import { FacingPanel } from "./FacingPanel";
import { LensPanel } from "./LensPanel";
import { LightPanel } from "./LightPanel";
import { MaskPanel } from "./MaskPanel";
import { openFile } from "./open";
import { PointsPanel } from "./PointsPanel";
import { sizeOf } from "./size";

export function Corrections() {
  const { panel } = messages;
  const shown = picture.value!;
  return (
    <>
      <section class="section is-tight" aria-label={panel.picture}>
        <div class="picture-line">
          <span class="picture-name">{shown.name}</span>
          <span class="count">{sizeOf(shown)}</span>
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
      </section>
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
    </>
  );
}
