// To show others: the body turning, as a film, and the photograph beside the body, as a picture.
import { useState } from "preact/hooks";
import type { Skin } from "../derived/skin";
import type { Fit } from "../api/fits";
import { messages } from "../messages/language";
import type { ResultFiles } from "../result/files";
import { IconButton } from "../ui/IconButton";
import { facingOf } from "../viewer/facing";
import { handOver } from "./handOver";

interface Props {
  readonly fit: Fit;
  readonly files: ResultFiles;
  readonly picture: HTMLImageElement;
  readonly skin: Skin;
}

export function Share({ fit, files, picture, skin }: Props) {
  const { share: words } = messages.value.look;
  const [state, setState] = useState<"film" | "pair" | "failed" | null>(null);
  /** Made, while the device wants another tap for it. */
  const [ready, setReady] = useState<File | null>(null);
  const give = async (file: File) => setReady((await handOver(file)) ? null : file);
  const make = async (what: "film" | "pair", file: () => Promise<File>) => {
    setState(what);
    setReady(null);
    try {
      await give(await file());
      setState(null);
    } catch {
      setState("failed");
    }
  };
  const { posed, canonical } = files;
  const upright = fit.links.artifacts?.["body_canonical.glb"];
  const film = async () => {
    const { turningFilm } = await import("./turntable");
    if (skin.path) return turningFilm({ path: skin.path, facing: facingOf(posed, canonical), stands: posed.upright !== null });
    return turningFilm({ path: upright!, facing: 0, stands: true });
  };
  const pair = async () => (await import("./beforeAndAfter")).beforeAndAfter(files, picture);
  const isBusy = state === "film" || state === "pair";
  return (
    <div class="look-share" role="group" aria-label={words.title}>
      {(skin.path || upright) && <IconButton icon="film" label={words.film} words={words.shortFilm} disabled={isBusy} onClick={() => void make("film", film)} />}
      {posed.camera && <IconButton icon="pair" label={words.pair} words={words.shortPair} disabled={isBusy} onClick={() => void make("pair", pair)} />}
      {ready && (
        <button class="button is-small is-primary" type="button" onClick={() => void give(ready)}>
          {words.now}
        </button>
      )}
      <p class="fine" role="status">
        {state === "film" ? words.filming : state === "failed" ? words.failed : ""}
      </p>
    </div>
  );
}
