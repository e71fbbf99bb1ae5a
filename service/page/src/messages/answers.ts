// Answers of the service by their codes, in the page's words where the service's own are for programs. All others are
// shown as the service writes them.
export const answers = {
  titles: {
    "fit-failed": "The fit failed",
    "invalid-request": "Something is missing or cannot be right",
    "not-found": "Nothing is here",
    "not-ready": "The service is not ready",
    "payload-too-large": "The file is too large",
    "time-limit-exceeded": "It took too long",
    "unusable-input": "This cannot be used",
    "page-error": "This page failed",
    "unexpected-answer": "An unexpected answer",
    unreachable: "The service does not answer",
  },
  faults: {
    "database-unavailable": "The service cannot reach its database just now. Try again in a moment.",
    "disk-full": "The service’s disk is nearly full. Try again later.",
    draining: "The service is being restarted. Try again in a moment.",
    "empty-upload": "This file is empty. Choose another one.",
    "estimator-failed": "Something went wrong while computing. Try again.",
    "estimator-timeout": "Computing took too long. Try again.",
    "estimator-unavailable": "The service is busy. Try again in a moment.",
    "fit-crashed": "This picture made the fit crash each time. Try another picture.",
    "fit-failed": "The fault is the service’s, not yours. Try again.",
    "fit-expired": "Picture and result were erased when their time was over. Start another fit.",
    "image-animated": "This picture moves. Choose one that stands still.",
    "image-damaged": "This picture is damaged. Choose another one.",
    "image-empty": "This picture is an empty file. Choose another one.",
    "image-unsupported": "This kind of picture is not taken. Choose a JPEG, PNG or WebP.",
    "input-gone": "The picture is no longer there. Start another fit.",
    "internal-error": "An unexpected fault of the service. Try again.",
    "mask-damaged": "This mask is damaged. Choose another one.",
    "mask-without-background": "This mask is all white. Only the person should be white.",
    "mask-without-foreground": "This mask is all black. The person should be white.",
    "no-light": "The fit found no light that could be taken out of the picture. Fit by outline and shading, or choose the colours as photographed.",
    "no-process": "The service could not begin. Try again.",
    "no-worker": "The service takes no fits just now. Try again in a moment.",
    "not-an-image": "This is not a picture. Choose a JPEG, PNG or WebP.",
    "not-found": "It does not exist, or it was erased.",
    "person-not-found":
      "No person is found where the points are. Check that they lie on the right joints, or use a picture of the whole person.",
    "point-outside-image": "This point lies outside the picture. Move it or remove it.",
    "points-too-close": "All points are close together. Crop the picture to the person, or check the points.",
    "queue-full": "Too many fits are waiting. Try again in a moment.",
    "storage-full": "The service’s storage is full. Try again later.",
    "storage-unavailable": "The service cannot reach its storage just now. Try again in a moment.",
    "submission-lost": "The request was lost. Send it again.",
    "time-limit-exceeded": "It took too long and was stopped. Try a smaller picture, or the outline alone.",
    "unknown-image": "The picture is no longer kept; it may have expired. Send it once more.",
    "page-error": "Reload the page and try again.",
    "unexpected-answer": "Something stands between this page and the service; reload the page.",
    unreachable: "No connection could be made. See whether it is running, then try again.",
  },
  warnings: {
    "ambiguous-limb-facing": "The picture fits about as well with some limbs slanting the other way. Say which under “Toward you or away”.",
    "body-outside-picture": "A part of the person is outside the picture. What is not seen is inferred from the rest.",
    "way-differs": "The body ends elsewhere than the motion file does: its feet stay where they touch the ground.",
    "clip-cut": "Only a part of the motion is shown: it is longer than an animation may be.",
    "clothes-not-loose":
      "This looks like underwear or swimwear. If nothing loose covers the body, say that the clothes are close-fitting: girths may be several centimetres too small otherwise.",
    "cut-off": "The person reaches the border of the picture. Points outside it are missing.",
    "different-people": "The pictures seem to show different people. Check the pictures and their points, or leave one out.",
    "given-contradicted": "One value that you gave contradicts the pictures and the height. Check it, and its unit.",
    implausible: "You asked for measurements all the same. They may be nobody’s: the picture contradicts the body.",
    "left-and-right-may-be-swapped":
      "Left and right may be swapped: both eyes are seen, but the points lie as if from behind. Left is the person’s own left.",
    "limbs-crossed": "Arms or legs cross in the picture. Check that left and right are right.",
    "low-silhouette-overlap":
      "The body covers little of the person. Check the points, check left and right, or correct the mask.",
    "no-person": "You asked for measurements all the same. They may be nobody’s: no person is seen where the points are.",
    "other-view":
      "In one of the pictures the person is turned otherwise than you said. Check which view it is, and whether it is mirrored.",
    "person-too-small": "The person is small in this picture, and measurements suffer. Crop it to them, or use a larger one.",
    "seen-from-behind": "The person seems to turn their back. Check that left and right are their own.",
    "segmentation-doubtful":
      "The person hardly stands out from the background, so the outline is a rough guess. Correct the mask.",
    "several-people": "Several people were found, and the largest is taken. Click one point of the person you mean.",
    "shading-not-used": "Too little bare, well-lit skin is seen to use shading. The result is by outline alone.",
    "shoulders-and-hips-disagree":
      "The shoulders say one side and the hips the other: a pair may be swapped. Left is the person’s own left.",
    "other-shape":
      "This picture is not of the shape in which the camera took it. If a program squeezed it, use the original.",
    "transparency-over-white": "The picture is partly transparent and was laid over white. If its opaque part is the person, use that as the mask.",
    "unusual-height":
      "Few people are this tall or this small, so ranges are wider. Check the height and the body that you chose.",
  },
  findings: {
    "nobody-found":
      "Nobody was found in this picture. Show the whole person, upright, in good light, with nothing in front of them.",
    "several-people": "Take the picture with one person alone. This one shows several, and the largest is measured.",
    "cut-off": "Step back until there is room all around the person. Here a part of them is cut off.",
    "person-too-small": "Go nearer until the person fills the picture, or crop it to them.",
    "picture-too-small": "Use the picture as the camera took it, not a preview: this one has too few pixels.",
    "other-view": "Turn as the picture asks: face the camera for the front, turn by a quarter for the side.",
    "arms-against-trunk": "Hold your arms away from your body, a hand’s breadth or more at the hips.",
    "clothes-loose": "Wear close-fitting clothes, or give the weight. Under loose clothes the body is only estimated.",
    "skin-not-found":
      "Use a picture in colour that shows the face, or say how the clothes fit. Without skin to go by, they are taken to be loose.",
    "face-hidden": "Show your face: it tells which way you face, and the colour of your skin.",
    covered:
      "Take the picture with nothing and nobody in front of the person or beside them. Something there covers or touches them, or looks like them: a part of the outline does not count, so ranges are wider.",
    "not-standing":
      "Stand upright, with straight legs. If you cannot stand, enter measurements taken with a tape: a body follows from those.",
    child: "Only adults can be measured, and these are the proportions of a child.",
    blurred: "Hold the camera still, focus on the person, and switch on more light. This picture is blurred.",
    "too-dark": "Switch on more light, from the camera’s side and not from behind. The person is too dark.",
    "too-bright": "Tap the person on the camera’s screen, or leave the glaring light. Much of the person is overexposed.",
    "camera-rolled": "Hold the camera level and stand upright. The person leans in this picture.",
    "camera-too-near": "Step back to 2.5 m or more, and zoom in. The camera was too near.",
    contradicted:
      "Check that the points lie on the joints of one person, and that a mask shows nobody else. The picture contradicts the body.",
  },
  verdicts: {
    implausible: "This picture cannot be measured. The notes say why, and what to do.",
    no_person: "No person is seen where the points are. Check the points, or choose another picture.",
  },
} as const;
