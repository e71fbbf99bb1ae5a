// What is done to the points without keys, beside the picture: over it they would lie on what is to be tapped.
import { change, points, selected, timeline, upcoming } from "../draft/draft";
import { messages } from "../messages";
import { isEnough, skip, skipRest, toggleHidden } from "../points/placed";
import { undo } from "../points/timeline";
import { IconButton } from "../ui/IconButton";
import type { PictureView } from "./pictureView";
import { ViewButtons } from "./ViewButtons";

export function StageTools({ lies }: { lies: PictureView }) {
  const { points: words, stage } = messages;
  const next = upcoming.value;
  const chosen = selected.value;
  const where = chosen && points.value.placed[chosen];
  return (
    <div class="stage-tools" role="toolbar" aria-label={stage.tools}>
      <IconButton
        icon="undo"
        label={stage.takeBack}
        disabled={timeline.value.past.length === 0}
        onClick={() => (timeline.value = undo(timeline.value))}
      />
      <ViewButtons of={lies} />
      {next && <IconButton icon="skip" label={stage.skip(words.labels[next])} onClick={() => change(skip(points.value, next))} />}
      {next && isEnough(points.value) && (
        <IconButton icon="check" label={stage.enough} onClick={() => change(skipRest(points.value))} />
      )}
      {where && (
        <IconButton
          icon="hidden"
          label={stage.hidden(words.labels[chosen])}
          pressed={where.hidden}
          onClick={() => change(toggleHidden(points.value, chosen))}
        />
      )}
    </div>
  );
}
