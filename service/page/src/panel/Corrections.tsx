// All that can be corrected before a fit: the picture, its points, the mask, limbs and the lens.
import { useSignal } from "@preact/signals";
import type { ViewKind } from "../api/types";
import { cues, current, mask, removeView, useMask, views } from "../draft/draft";
import { replaceFile } from "../draft/open";
import { openPicture } from "../draft/picture";
import { MaskSection } from "../mask/MaskSection";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";
import { FileButton } from "../ui/FileButton";
import { FacingPanel } from "./FacingPanel";
import { LensPanel } from "./LensPanel";
import { PointsPanel } from "./PointsPanel";

export function Corrections() {
  const { panel } = messages;
  return (
    <>
      <PictureSection />
      <PointsPanel />
      <MaskSection />
      <FacingPanel />
      <details class="section fold-section">
        <summary>
          <h2>{panel.evidence}</h2> <span class="count">{panel.optional}</span>
        </summary>
        <LensPanel />
        <Evidence />
        <OwnMask />
      </details>
    </>
  );
}

function PictureSection() {
  const { measure, panel } = messages;
  const { picture, view } = current.value!;
  const isOfSeveral = views.value.length > 1;
  return (
    <section class="section is-tight" aria-label={panel.picture}>
      <div class="picture-line">
        <span class="picture-name">{picture.name}</span>
        <span class="count">{sizeOf(picture)}</span>
        <FileButton look="link" named={panel.another} onChoose={([file]) => void replaceFile(file!)}>
          {panel.replace}
        </FileButton>
        {isOfSeveral && (
          <button class="link" type="button" onClick={removeView}>
            {panel.remove}
          </button>
        )}
      </div>
      {isOfSeveral && (
        <Choice
          name="view"
          legend={panel.shows}
          options={(Object.keys(measure.views) as ViewKind[]).map((value) => ({ value, label: measure.views[value].label }))}
          value={view.value}
          onChange={(value) => (view.value = value)}
        />
      )}
    </section>
  );
}

/** By what the body is found: by its outline alone, or by its shading as well. */
function Evidence() {
  const { cues: byWhat } = messages.panel;
  return (
    <div class="subsection">
      <Choice
        name="cues"
        legend={byWhat.title}
        options={[
          { value: "SES", label: byWhat.shading },
          { value: "SE", label: byWhat.outline },
        ]}
        value={cues.value}
        onChange={(value) => (cues.value = value)}
      />
      <p class="fine">{cues.value === "SES" ? byWhat.shadingHelp : byWhat.outlineHelp}</p>
    </div>
  );
}

/** The person cut out beforehand, for those who have a mask. */
function OwnMask() {
  const { mask: words } = messages.panel;
  const fault = useSignal<string | null>(null);
  const chosen = mask.value;
  const open = async (file: File) => {
    try {
      const cut = await openPicture(file, file.name);
      const { picture } = current.value!;
      const fits = cut.width === picture.width && cut.height === picture.height;
      fault.value = fits ? null : words.misfit(sizeOf(cut), sizeOf(picture));
      if (fits) useMask(cut);
    } catch (error) {
      fault.value = (error as Error).message;
    }
  };
  return (
    <div class="subsection">
      <h3>{words.title}</h3>
      <p class="fine">{chosen ? words.used(chosen.name) : words.help}</p>
      <div class="row">
        <FileButton onChoose={([file]) => void open(file!)}>{chosen ? words.another : words.choose}</FileButton>
        {chosen && (
          <button class="button is-small" type="button" onClick={() => useMask(null)}>
            {words.leave}
          </button>
        )}
      </div>
      {fault.value && (
        <p class="note is-problem" role="alert">
          {fault.value}
        </p>
      )}
    </div>
  );
}

/** "720 × 960". */
function sizeOf({ width, height }: { readonly width: number; readonly height: number }): string {
  return `${width} × ${height}`;
}
