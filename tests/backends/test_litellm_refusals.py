"""Refusals in the providers' own words: which fault they are, and how long to wait."""

import email.utils
import json
import time

import pytest

from proc3s_litellm.faults import diagnose
from proc3s_litellm.refusals import refused, retry_after, words


def openai(message, code=None):
    return {"error": {"message": message, "type": "invalid_request_error", "param": None, "code": code}}


def anthropic(kind, message):
    return {"type": "error", "error": {"type": kind, "message": message}}


def gemini(code, status, message, *details):
    return [{"error": {"code": code, "message": message, "status": status, "details": list(details)}}]


FREE_TIER = (
    "You exceeded your current quota, please check your plan and billing details. Please retry in 36.5s."
)
MINUTE = {"quotaId": "GenerateRequestsPerMinutePerProjectPerModel-FreeTier"}
DAY = {"quotaId": "GenerateRequestsPerDayPerProjectPerModel-FreeTier"}
DELAY = {"@type": "type.googleapis.com/google.rpc.RetryInfo", "retryDelay": "36s"}

REFUSALS = [
    ("auth", 401, openai("Incorrect API key provided: sk-abc.", "invalid_api_key")),
    ("auth", 401, anthropic("authentication_error", "invalid x-api-key")),
    ("auth", 400, gemini(400, "INVALID_ARGUMENT", "API key not valid. Please pass a valid API key.")),
    ("auth", 403, openai("Country, region, or territory not supported", "unsupported_country")),
    ("auth", 403, "<html><head><title>403 Forbidden</title></head></html>"),
    ("quota", 429, openai("You exceeded your current quota, please check your plan.", "insufficient_quota")),
    ("quota", 400, anthropic("invalid_request_error", "Your credit balance is too low to access the API.")),
    ("quota", 402, {"error": {"message": "Insufficient Balance", "code": "invalid_request_error"}}),
    ("quota", 402, {"error": {"message": "", "code": 402}}),
    ("quota", 403, {"code": "forbidden", "error": "Your team has used all available credits."}),
    ("quota", 429, gemini(429, "RESOURCE_EXHAUSTED", FREE_TIER, DAY, DELAY)),
    ("rate_limit", 429, gemini(429, "RESOURCE_EXHAUSTED", FREE_TIER, MINUTE, DELAY)),
    ("rate_limit", 429, openai("Rate limit reached for model gpt-4o on requests per min", "rate_limit")),
    ("rate_limit", 429, {"detail": "Too many requests"}),
    ("rate_limit", 429, "slow down"),
    (
        "context",
        400,
        openai("This model's maximum context length is 8192 tokens.", "context_length_exceeded"),
    ),
    (
        "context",
        400,
        anthropic("invalid_request_error", "prompt is too long: 213462 tokens > 200000 maximum"),
    ),
    ("context", 400, openai("the request exceeds the available context size", "exceed_context_size_error")),
    (
        "context",
        400,
        gemini(400, "INVALID_ARGUMENT", "The input token count exceeds the maximum number of tokens"),
    ),
    ("context", 413, openai("Request too large for model on tokens per minute", "rate_limit_exceeded")),
    ("context", 429, openai("Request too large for gpt-4o on tokens per min: Limit 30000, Requested 31000")),
    ("context", 500, {"error": "context length exceeded"}),
    (
        "filtered",
        400,
        openai("The response was filtered by the content management policy.", "content_filter"),
    ),
    ("filtered", 400, openai("Your request was rejected as a result of our safety system.")),
    ("filtered", 400, anthropic("invalid_request_error", "Output blocked by content filtering policy")),
    ("filtered", 400, {"error": {"message": "Content Exists Risk", "code": "invalid_request_error"}}),
    ("filtered", 403, {"error": {"message": "Your input was flagged", "code": 403}}),
    ("unknown_model", 404, openai("The model `gpt-9` does not exist", "model_not_found")),
    ("unknown_model", 404, anthropic("not_found_error", "model: claude-9")),
    ("unknown_model", 400, {"error": {"message": "x/y is not a valid model ID", "code": 400}}),
    ("unknown_model", 400, {"error": {"message": "Model Not Exist"}}),
    ("unknown_model", 403, openai("Project `p` does not have access to model `o3`", "model_not_found")),
    ("unknown_model", 404, "404 page not found"),
    ("timeout", 408, ""),
    ("timeout", 504, "<html>Gateway Timeout</html>"),
    ("server", 500, openai("The server had an error while processing your request")),
    ("server", 503, {"error": {"message": "Loading model", "code": 503}}),
    ("server", 529, anthropic("overloaded_error", "Overloaded")),
    ("other", 400, openai("'temperature' does not support 0.0 with this model.", "unsupported_value")),
    (
        "other",
        422,
        {"detail": [{"msg": "Input should be a number", "input": "content filter, api key invalid"}]},
    ),
    ("other", 400, "null"),
]


def body_of(body):
    return body if isinstance(body, str) else json.dumps(body)


@pytest.mark.parametrize(("fault", "status", "body"), REFUSALS)
def test_a_refusal_is_the_fault_that_it_means(fault, status, body):
    assert refused(status, body_of(body), {}).fault == fault


@pytest.mark.parametrize(
    ("headers", "seconds"),
    [
        ({"retry-after": "7"}, 7.0),
        ({"retry-after": "0.5"}, 0.5),
        ({"retry-after-ms": "1500", "retry-after": "9"}, 1.5),
        ({"retry-after": "Wed, 21 Oct 2015 07:28:00 GMT"}, 0.0),
        ({"retry-after": "soon"}, None),
        ({"retry-after": "nan"}, None),
        ({"retry-after": "inf"}, None),
        ({"retry-after": "-3"}, None),
        ({}, None),
    ],
)
def test_how_long_to_wait_is_read_from_the_headers(headers, seconds):
    assert retry_after(headers) == seconds


def test_a_date_is_as_many_seconds_as_are_left_until_then():
    date = email.utils.formatdate(time.time() + 100, usegmt=True)
    assert retry_after({"retry-after": date}) == pytest.approx(100, abs=3)


def test_gemini_says_in_the_body_how_long_to_wait():
    body = json.dumps(gemini(429, "RESOURCE_EXHAUSTED", FREE_TIER, MINUTE))
    assert refused(429, body, {}).retry_after == 36.5


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (json.dumps(openai("no such key")), "no such key"),
        (json.dumps({"error": "model is loading"}), "model is loading"),
        (json.dumps({"detail": "Not Found"}), "Not Found"),
        (json.dumps({"detail": [{"msg": "a"}, {"msg": "b"}]}), "a; b"),
        (
            json.dumps({"error": {"message": "Provider error", "metadata": {"raw": "busy"}}}),
            "Provider error: busy",
        ),
        ("<!DOCTYPE html><html><p>secret page</p></html>", "a page of HTML"),
        ("two\nlines \x1b[31mand colours\x07", "two lines [31mand colours"),
        ("", ""),
        ("[]", "[]"),
    ],
)
def test_what_a_body_says_to_people(body, said):
    assert words(body) == said


def test_what_the_caller_was_busy_with_is_not_the_cause():
    import httpx

    def time_out_amid_another_failure():
        request = httpx.Request("POST", "http://127.0.0.1/")
        response = httpx.Response(401, request=request)
        try:
            raise httpx.HTTPStatusError("before", request=request, response=response)
        except httpx.HTTPStatusError:
            raise httpx.ReadTimeout("now") from None

    with pytest.raises(httpx.ReadTimeout) as caught:
        time_out_amid_another_failure()
    assert diagnose(caught.value).fault == "timeout"
