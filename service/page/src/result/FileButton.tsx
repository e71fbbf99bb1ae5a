// A file of a result: what it is, and how to keep it, a mesh in other formats too.
import { useSignal } from "@preact/signals";
import { getFile } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem } from "../api/types";
import { Icon } from "../ui/Icon";
import { ProblemNote } from "../ui/ProblemNote";
import { saveFile } from "../ui/save";

export const FILE_LABELS: Readonly<Record<string, string>> = {
  "body_posed.glb": "Posed body with camera, light and skin",
  "body_canonical.glb": "Upright body",
  "body_posed_se.glb": "Posed body before shading refined it",
  "body_canonical_se.glb": "Upright body before shading refined it",
  "tapes.json": "Where each measurement is taken",
  "result.json": "Everything found, as numbers",
  "measurements.csv": "The measurements, for a spreadsheet",
  "person.npz": "The person as fitted, to make more of",
  "overlay.png": "Outline over the picture",
  "views.png": "The body from other sides",
  "segmentation.png": "What was taken for the person",
  "trimap.png": "What that began with",
  "albedo.png": "Albedo",
  "shading.png": "Shading by Eq. 1",
  "shading_lambertian.png": "Its diffuse part",
  "report.html": "One page, to read",
  "report.pdf": "The same, to print",
  "body_caricature.glb": "The caricature in the picture’s pose",
  "caricature.png": "Beside the fitted body",
  "body_reposed.glb": "The body in this pose",
  "pose.png": "Seen from other sides",
  "body_animated.glb": "Moving exactly, as morph targets",
  "body_skinned.glb": "Moving by bones and skin, for game engines",
  "animation.webp": "The motion as a moving picture",
  "animation.png": "Moments of it, from the front and the side",
  "body_textured.glb": "The body with the texture",
  "texture.png": "The texture alone",
  "atlas.png": "Where the texture has which part, to paint on",
  "coverage.png": "What of it was seen, mirrored, continued",
  "figure.png": "As in the paper’s Fig. 10",
  "body_combined.glb": "The body the pictures agree on, upright",
  "body_posed_N.glb": "The common body as posed in that picture, with its light",
  "overlay_N.png": "The common body over that picture",
  "segmentation_N.png": "What was taken for the person in that picture",
  "scan.png": "The body beside its pictures",
  "combined.png": "Beside the body by this fit alone",
};

/** What the service writes of any mesh when it is asked for. */
const FORMATS = ["obj", "ply", "stl", "usdz"];

/** The material of an OBJ with a texture is a file beside it. */
const TEXTURED = "body_textured.glb";

export function FileButton({ name, path, bytes }: { name: string; path: string; bytes?: number }) {
  const problem = useSignal<Problem | null>(null);
  const keep = async (kept: string, from: string) => {
    try {
      saveFile(kept, await getFile(from));
      problem.value = null;
    } catch (error) {
      problem.value = problemFrom(error);
    }
  };
  return (
    <>
      <button class="download" type="button" onClick={() => keep(name, path)}>
        <Icon name="download" />
        <span>
          {name}
          <small>{FILE_LABELS[name] ?? FILE_LABELS[name.replace(/_\d+\./, "_N.")]}</small>
        </span>
        <small>{sizeText(bytes)}</small>
      </button>
      {name.endsWith(".glb") && (
        <p class="download-formats">
          {[...FORMATS, ...(name === TEXTURED ? ["mtl"] : [])].map((ending) => (
            <button
              key={ending}
              class="link"
              type="button"
              aria-label={withEnding(name, ending)}
              onClick={() => keep(withEnding(name, ending), withEnding(path, ending))}
            >
              {ending.toUpperCase()}
            </button>
          ))}
        </p>
      )}
      {problem.value && <ProblemNote problem={problem.value} />}
    </>
  );
}

function withEnding(name: string, ending: string): string {
  return name.replace(/glb$/, ending);
}

function sizeText(bytes: number | undefined): string {
  if (bytes === undefined) return "";
  return bytes < 1e6 ? `${Math.max(1, Math.round(bytes / 1e3))} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}
