"""An uploaded picture itself, as it was sent or as every browser shows it."""

from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import Service
from tests.integration.service.test_bad_input import checked
from tests.integration.service.test_formats import wait_for_estimator
from tests.integration.service.test_images import uploaded


def test_an_uploaded_picture_can_be_had_as_it_was_sent_or_as_a_jpeg(service: Service):
    wait_for_estimator(service)
    content = scripted_image({"n": 5}, width=300, height=200)
    path = f"/v1/images/{uploaded(service, content).id}/picture"
    sent = service.client.get(path)
    assert (sent.headers["content-type"], sent.content) == ("image/png", content)
    jpeg = service.client.get(path, headers={"Accept": "image/jpeg"})
    assert (jpeg.status_code, jpeg.headers["content-type"]) == (200, "image/jpeg")
    assert jpeg.content.startswith(f"JPEG of {len(content)} bytes".encode())
    for each in (sent, jpeg):
        assert each.headers["Vary"] == "Accept"
        known = {"If-None-Match": each.headers["etag"], "Accept": each.headers["content-type"]}
        assert service.client.get(path, headers=known).status_code == 304
    assert service.client.delete(path.removesuffix("/picture")).status_code == 204
    checked(service.client.get(path), 404)
