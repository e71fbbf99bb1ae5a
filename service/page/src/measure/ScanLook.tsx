// The body over its pictures side by side, or upright to be turned.
import { useState } from "preact/hooks";
import type { Scan, ScanResult } from "../api/types";
import type { Picture } from "../draft/picture";
import { usePictureOf } from "../result/files";
import type { FilesOf } from "../result/files";
import { Choice } from "../ui/Choice";
import { BodyCanvas } from "../viewer/BodyCanvas";

export type Shown = "pictures" | "upright";

const SHOWN: readonly { value: Shown; label: string; title: string }[] = [
  { value: "pictures", label: "Over the pictures", title: "The body's outline over each picture" },
  { value: "upright", label: "Turn", title: "In the pose it is measured in; drag to turn" },
];

interface Props {
  readonly scan: Scan;
  readonly files: FilesOf<ScanResult>;
  readonly picture: Picture;
  readonly shown: Shown;
  readonly onShow: (shown: Shown) => void;
  readonly measure: string | null;
}

export function ScanLook({ scan, files, picture, shown, onShow, measure }: Props) {
  const [failed, setFailed] = useState(false);
  return (
    <div class={`look is-scan ${shown === "pictures" ? "is-pictures" : ""}`}>
      <div class="look-bar">
        <Choice name="scan-shown" legend="View" quiet options={SHOWN} value={shown} onChange={onShow} />
      </div>
      {shown === "pictures" ? (
        <div class="overlays">
          {files.result.views.map(({ number, view }) => (
            <Overlay key={number} scan={scan} number={number} view={view} />
          ))}
        </div>
      ) : (
        <div class="look-room">
          <div class="look-free">
            {failed ? (
              <p class="note is-problem" role="alert">
                This browser offers no WebGL 2, which the 3D view needs. The downloads below have pictures of the body.
              </p>
            ) : (
              <BodyCanvas
                posed={files.posed}
                outlined={null}
                body="SES"
                canonical={files.canonical}
                picture={picture.element}
                tapes={files.tapes}
                marked={measure}
                placement="canonical"
                surface="clay"
                opacity={1}
                onFailure={() => setFailed(true)}
              />
            )}
          </div>
          <p class="look-hint fine">Drag to turn · wheel or pinch to come nearer</p>
        </div>
      )}
    </div>
  );
}

function Overlay({ scan, number, view }: { scan: Scan; number: number; view: string }) {
  const url = usePictureOf(scan, `overlay_${number}.png`, true);
  return (
    <figure class="overlay">
      {url && <img src={url} alt={`The body's outline over the ${view} picture`} data-shows={`overlay_${number}`} />}
      <figcaption>{view.charAt(0).toUpperCase() + view.slice(1)}</figcaption>
    </figure>
  );
}
