// The body over its picture, from every side, or upright; its surface as Eq. 1 has it or in parts.
import { useState } from "preact/hooks";
import type { Job } from "../api/types";
import type { Picture } from "../draft/picture";
import { Choice } from "../ui/Choice";
import { BodyCanvas } from "../viewer/BodyCanvas";
import type { Placement } from "../viewer/BodyScene";
import type { Cues } from "../api/types";
import type { Surface } from "../viewer/surface";
import { MaskOutline } from "../ui/MaskOutline";
import { useBodiesBeforeShading, usePictureOf } from "./files";
import type { ResultFiles } from "./files";

const PLACEMENTS: readonly { value: Placement; label: string; title: string }[] = [
  { value: "picture", label: "Over the picture", title: "As the camera saw it" },
  { value: "turned", label: "Turn", title: "Drag to turn, wheel or pinch to come nearer" },
  { value: "canonical", label: "Upright", title: "In the pose it is measured in" },
];
const CLAY: { value: Surface; label: string; title: string } = { value: "clay", label: "Clay", title: "Shape alone" };
const SURFACES: readonly { value: Surface; label: string; title: string }[] = [
  { value: "lit", label: "Lit", title: "Eq. 1: ambient, diffuse and specular light on the skin found" },
  CLAY,
  { value: "albedo", label: "Albedo", title: "The share of light the skin throws back in all directions" },
  { value: "specularity", label: "Gloss", title: "Specularity: the share it mirrors" },
  { value: "shading", label: "Shading", title: "The light alone, on an even skin" },
  { value: "residual", label: "Residual", title: "Red: the picture is brighter than Eq. 1; blue: darker" },
];
const CHANGE: { value: Surface; label: string; title: string } = {
  value: "change",
  label: "Change",
  title: "What shading changed of the outline's body. Red: outward, blue: inward; full colour at 1 cm",
};
const BODIES: readonly { value: Cues; label: string; title: string }[] = [
  { value: "SES", label: "With shading", title: "SES: silhouette, edges and shading" },
  { value: "SE", label: "Outline alone", title: "SE: silhouette and edges, before shading refined it" },
];

interface Props {
  readonly job: Job;
  readonly files: ResultFiles;
  readonly picture: Picture;
  readonly placement: Placement;
  readonly onPlace: (placement: Placement) => void;
  readonly measure: string | null;
}

export function Look({ job, files, picture, placement, onPlace, measure }: Props) {
  const hasSkin = files.posed.light !== null;
  const [surface, setSurface] = useState<Surface>("clay");
  const [opacity, setOpacity] = useState(0.85);
  const [lines, setLines] = useState(false);
  const [mask, setMask] = useState(false);
  const [failed, setFailed] = useState(false);
  const [body, setBody] = useState<Cues>("SES");
  const comparable = job.links.artifacts?.["body_posed_se.glb"] !== undefined;
  const outlined = useBodiesBeforeShading(job, comparable && (body === "SE" || surface === "change"));
  const surfaces = !hasSkin || body === "SE" ? [CLAY] : comparable ? [...SURFACES, CHANGE] : SURFACES;
  const over = placement === "picture";
  const overlay = usePictureOf(job, "overlay.png", lines && over);
  const segmentation = usePictureOf(job, "segmentation.png", mask && over);
  return (
    <div class="look">
      <div class="look-bar">
        <Choice name="placement" legend="View" quiet options={PLACEMENTS} value={placement} onChange={onPlace} />
        <Choice
          name="surface"
          legend="Surface"
          quiet
          options={surfaces}
          value={surface}
          onChange={setSurface}
        />
      </div>
      <div class="look-room">
        <div
          class={over ? "look-picture" : "look-free"}
          style={{ "--ratio": String(picture.width / picture.height) }}
        >
          {over && <img src={lines && overlay ? overlay : picture.url} alt="The picture" />}
          {failed ? (
            <p class="note is-problem" role="alert">
              This browser offers no WebGL 2, which the 3D view needs. The downloads below have pictures of the body.
            </p>
          ) : (
            <BodyCanvas
              posed={files.posed}
              outlined={outlined}
              body={body}
              canonical={files.canonical}
              picture={picture.element}
              tapes={files.tapes}
              marked={measure}
              placement={placement}
              surface={surface}
              opacity={over ? opacity : 1}
              onFailure={() => setFailed(true)}
            />
          )}
          {over && mask && segmentation && <MaskOutline url={segmentation} label="The silhouette found in the picture" />}
        </div>
        {!over && <p class="look-hint fine">Drag to turn · wheel or pinch to come nearer</p>}
      </div>
      {surface === "change" && (
        <p class="look-legend fine">
          What shading changed of the outline’s body: <b class="is-outward">outward</b>, <b class="is-inward">inward</b>; full
          colour at 1 cm.
        </p>
      )}
      {(comparable || over) && (
        <div class="look-bar">
          {comparable && (
            <Choice
              name="compared"
              legend="Body found"
              quiet
              options={BODIES}
              value={body}
              onChange={(value) => {
                setBody(value);
                if (value === "SE") setSurface("clay");
              }}
            />
          )}
          {over && (
            <>
              <label class="slider">
                <span>Body</span>
                <input
                  type="range"
                  min="0"
                  max="1"
                  step="0.01"
                  value={opacity}
                  aria-label="Opacity of the body"
                  onInput={(event) => setOpacity(Number(event.currentTarget.value))}
                />
                <output>{Math.round(100 * opacity)} %</output>
              </label>
              <label class="check">
                <input type="checkbox" checked={mask} onChange={(event) => setMask(event.currentTarget.checked)} />
                Silhouette of the picture
              </label>
              <label class="check">
                <input
                  type="checkbox"
                  checked={lines}
                  onChange={(event) => {
                    setLines(event.currentTarget.checked);
                    if (event.currentTarget.checked) setOpacity(0);
                  }}
                />
                Outline and edges of the body
              </label>
            </>
          )}
        </div>
      )}
    </div>
  );
}
