// The camera over the whole screen: a silhouette to match, a level, a countdown. It is off as soon as this is gone.
import { useEffect, useRef, useState } from "preact/hooks";
import { announce } from "../ui/announce";
import { Choice } from "../ui/Choice";
import { IconButton } from "../ui/IconButton";
import { beep } from "./beep";
import { cameraTrouble, closeCamera, openCamera, takePicture } from "./lens";
import type { Side } from "./lens";
import { levelWord, useTilt } from "./level";
import type { Tilt } from "./level";
import { SilhouetteOutline } from "./Silhouette";
import type { PlaceName } from "./places";

const SECONDS = ["3", "5", "10"] as const;
type Seconds = (typeof SECONDS)[number];

interface Props {
  readonly view: PlaceName;
  readonly onTaken: (picture: Blob) => void;
  readonly onClose: () => void;
}

export function Camera({ view, onTaken, onClose }: Props) {
  const dialog = useRef<HTMLDialogElement>(null);
  const video = useRef<HTMLVideoElement>(null);
  const [side, setSide] = useState<Side>("environment");
  const [seconds, setSeconds] = useState<Seconds>("5");
  const [stream, setStream] = useState<MediaStream | null>(null);
  const [left, setLeft] = useState<number | null>(null);
  const [trouble, setTrouble] = useState<string | null>(null);
  const tilt = useTilt();

  useEffect(() => {
    dialog.current!.showModal();
    const hide = () => document.hidden && onClose();
    document.addEventListener("visibilitychange", hide);
    return () => document.removeEventListener("visibilitychange", hide);
  }, []);

  useEffect(() => {
    let gone = false;
    let opened: MediaStream | null = null;
    setStream(null);
    setTrouble(null);
    openCamera(side).then(
      (found) => {
        if (gone) return closeCamera(found);
        opened = found;
        video.current!.srcObject = found;
        setStream(found);
      },
      (error) => gone || setTrouble(cameraTrouble(error)),
    );
    return () => {
      gone = true;
      closeCamera(opened);
    };
  }, [side]);

  useEffect(() => {
    if (left === null || !stream) return undefined;
    let gone = false;
    beep(left === 0);
    if (left > 0) {
      announce(String(left));
      const timer = setTimeout(() => setLeft(left - 1), 1000);
      return () => clearTimeout(timer);
    }
    takePicture(stream, video.current!).then(
      (picture) => gone || onTaken(picture),
      (error: Error) => {
        setLeft(null);
        setTrouble(error.message);
      },
    );
    return () => {
      gone = true;
    };
  }, [left, stream]);

  const mirrored = side === "user";
  const counts = left !== null;
  return (
    <dialog ref={dialog} class="camera" aria-label={`Camera: ${view} picture`} onClose={onClose}>
      <div class="camera-room">
        <video ref={video} class={mirrored ? "is-mirrored" : ""} autoplay muted playsInline aria-label="What the camera sees" />
        <SilhouetteOutline view={view} mirrored={mirrored} />
        {tilt && <Level tilt={tilt} facesUser={mirrored} />}
        {counts && (
          <p class="camera-count" aria-hidden="true">
            {left === 0 ? "✓" : left}
          </p>
        )}
        {trouble && (
          <p class="note is-problem" role="alert">
            {trouble}
          </p>
        )}
      </div>
      <div class="camera-bar">
        <div class="camera-choices">
          <Choice
            name="countdown"
            legend="Countdown"
            quiet
            options={SECONDS.map((value) => ({ value, label: `${value} s` }))}
            value={seconds}
            onChange={setSeconds}
          />
          <IconButton
            icon="swap"
            label={mirrored ? "Use the back camera" : "Use the front camera"}
            disabled={counts}
            onClick={() => setSide(mirrored ? "environment" : "user")}
          />
        </div>
        <div class="camera-choices">
          <button class="button" type="button" onClick={() => dialog.current!.close()}>
            Close
          </button>
          <button class="button is-primary" type="button" disabled={!stream || left === 0} onClick={() => setLeft(counts ? null : Number(seconds))}>
            {counts ? "Stop" : `Take it in ${seconds} s`}
          </button>
        </div>
      </div>
    </dialog>
  );
}

function Level({ tilt, facesUser }: { tilt: Tilt; facesUser: boolean }) {
  const word = levelWord(tilt, facesUser);
  return (
    <p class={`camera-level ${word ? "" : "is-level"}`}>
      <i style={{ rotate: `${-tilt.roll}deg` }} aria-hidden="true" />
      {word ?? "Level"}
    </p>
  );
}
