// The body in the colours of the picture: it comes out of the photograph, turns once, and can be shown to others.
import { useRef, useState } from "preact/hooks";
import type { Picture } from "../draft/picture";
import { messages } from "../messages";
import type { Skin } from "../products/skin";
import { IconButton } from "../ui/IconButton";
import { saveFile } from "../ui/save";
import { DerivedCanvas } from "../viewer/DerivedCanvas";
import type { Snapshot } from "../viewer/DerivedCanvas";
import type { Side } from "../viewer/Turntable";
import type { ResultFiles } from "./files";

const PICTURE = "body.png";

interface Props {
  readonly skin: Skin;
  readonly files: ResultFiles;
  /** That of the files. */
  readonly picture: Picture;
  readonly from: { readonly side: Side } | null;
  /** It comes out of the picture only once. */
  readonly isOut: boolean;
  readonly onOut: (take: Snapshot) => void;
}

export function Coloured({ skin, files, picture, from, isOut, onOut }: Props) {
  const { look, products } = messages;
  const [emerges] = useState(!isOut && files.number === 0);
  const take = useRef<Snapshot | null>(null);
  return (
    <div class="look-free">
      <img class={`look-photo ${isOut ? "is-leaving" : ""}`} src={picture.url} alt={isOut ? "" : look.picture} />
      {skin.path ? (
        <DerivedCanvas
          path={skin.path}
          label={products.texture.turned}
          like={files}
          turns
          emerges={emerges}
          from={from}
          onSeen={(snapshot) => {
            take.current = snapshot;
            onOut(snapshot);
          }}
        />
      ) : (
        <div class="look-loading" role="status">
          {look.skinComes}
        </div>
      )}
      {isOut && (
        <div class="look-share">
          <IconButton icon="share" label={look.share} onClick={() => void share(take.current)} />
        </div>
      )}
    </div>
  );
}

/** By the device's own way where it has one, else as a file. */
async function share(take: Snapshot | null): Promise<void> {
  const picture = take?.();
  const content = picture && (await new Promise<Blob | null>((done) => picture.toBlob(done, "image/png")));
  if (!content) return;
  const files = [new File([content], PICTURE, { type: content.type })];
  if (!navigator.canShare?.({ files })) return saveFile(PICTURE, content);
  // Whoever thinks better of it has not failed.
  await navigator.share({ files }).catch(() => undefined);
}
