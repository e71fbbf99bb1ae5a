// The camera over the whole screen: a silhouette to match, a level, a countdown. It is off as soon as this is gone.
import { useEffect, useRef, useState } from "preact/hooks";
import { seconds as inSeconds } from "../messages/figures";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";
import { IconButton } from "../ui/IconButton";
import { allowSound, beep } from "./beep";
import { cameraTrouble, closeCamera, isFilming, openCamera, takePicture } from "./lens";
import type { CameraTrouble, Side } from "./lens";
import { SpiritLevel } from "./SpiritLevel";
import { PictureFile } from "./PictureFile";
import { SilhouetteOutline } from "./Silhouette";
import type { PlaceName } from "./places";
import { pictureOf } from "./views";

const SECONDS = ["3", "5", "10"] as const;
type Seconds = (typeof SECONDS)[number];

interface Props {
  readonly view: PlaceName;
  readonly onTaken: (picture: Blob, name: string) => void;
  readonly onClose: () => void;
}

export function Camera({ view, onTaken, onClose }: Props) {
  const { frame, measure } = messages;
  const { camera: words } = measure;
  const dialog = useRef<HTMLDialogElement>(null);
  const video = useRef<HTMLVideoElement>(null);
  const [side, setSide] = useState<Side>("environment");
  const [seconds, setSeconds] = useState<Seconds>("5");
  const [stream, setStream] = useState<MediaStream | null>(null);
  const [left, setLeft] = useState<number | null>(null);
  const [trouble, setTrouble] = useState<CameraTrouble | null>(null);
  /** Width over height of what the camera sees: the drawing lies on it, not on the room around. */
  const [ratio, setRatio] = useState<number | null>(null);

  useEffect(() => {
    dialog.current!.showModal();
    isFilming.value = true;
    return () => {
      isFilming.value = false;
    };
  }, []);

  // A camera that nobody sees is switched off. Without one the page stays: a phone hides it behind its file picker.
  useEffect(() => {
    if (!stream) return undefined;
    const hide = () => document.hidden && onClose();
    document.addEventListener("visibilitychange", hide);
    return () => document.removeEventListener("visibilitychange", hide);
  }, [stream]);

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
      const timer = setTimeout(() => setLeft(left - 1), 1000);
      return () => clearTimeout(timer);
    }
    takePicture(stream, video.current!).then(
      (picture) => gone || onTaken(picture, view),
      () => {
        setLeft(null);
        setTrouble("noPicture");
      },
    );
    return () => {
      gone = true;
    };
  }, [left, stream]);

  const mirrored = side === "user";
  const counts = left !== null;
  const countOrStop = () => {
    allowSound();
    setTrouble(null);
    setLeft(counts ? null : Number(seconds));
  };
  return (
    <dialog ref={dialog} class="camera" aria-label={words.label(pictureOf(view))} onClose={onClose}>
      <div class="camera-room">
        <div class="camera-view" style={ratio ? { "--ratio": ratio } : {}}>
          <video
            ref={video}
            class={mirrored ? "is-mirrored" : ""}
            autoplay
            muted
            playsInline
            aria-label={words.sees}
            onResize={({ currentTarget: { videoWidth, videoHeight } }) => videoHeight && setRatio(videoWidth / videoHeight)}
          />
          {stream && ratio && <SilhouetteOutline view={view} mirrored={mirrored} />}
        </div>
        {stream && <SpiritLevel facesUser={mirrored} />}
        {counts && (
          <p class="camera-count" aria-hidden="true">
            {left === 0 ? "✓" : left}
          </p>
        )}
        {/* Of what lies outside a dialog no screen reader tells while it is open. */}
        <p class="unseen" role="status">
          {counts ? (left === 0 ? words.taken : left) : ""}
        </p>
        {trouble && (
          <div class="note is-problem" role="alert">
            <p>{words.troubles[trouble]}</p>
            <PictureFile label={measure.place.choose} named={words.chooseInstead(pictureOf(view))} onChoose={onTaken} />
          </div>
        )}
      </div>
      <div class="camera-bar">
        <div class="camera-choices">
          <Choice
            name="countdown"
            legend={words.countdown}
            quiet
            options={SECONDS.map((value) => ({ value, label: inSeconds(Number(value), 0) }))}
            value={seconds}
            onChange={setSeconds}
          />
          <IconButton
            icon="swap"
            label={mirrored ? words.useBack : words.useFront}
            disabled={counts}
            onClick={() => setSide(mirrored ? "environment" : "user")}
          />
        </div>
        <div class="camera-choices">
          <button class="button" type="button" onClick={() => dialog.current!.close()}>
            {frame.close}
          </button>
          <button class="button is-primary" type="button" disabled={!stream || left === 0} onClick={countOrStop}>
            {counts ? words.stop : words.takeIn(inSeconds(Number(seconds), 0))}
          </button>
        </div>
      </div>
    </dialog>
  );
}
