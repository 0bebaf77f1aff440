// SPDX-License-Identifier: MIT
//
// The numbers and words of a scene as a page has them, and what an output that comes to nothing leaves of its folders.
#include "folder.h"

#include "results/page.h"

// The data of the page, from its first brace on; free it.
static char *data_of(const moray_scene *scene)
{
    char *text = NULL, *data = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    moray_html_scene(file, scene);
    fclose(file);
    char *from = strstr(text, "id=\"scene-data\">\n");
    data = strdup(from ? from + 17 : "");
    free(text);
    return data;
}

// To four digits, of which half a unit or less is 0; the path that is asked for to three.
static void test_numbers(void)
{
    static const double at[] = {5e-5, -4.5e-5, 5.5e-5, 1.23456, -2, NAN, INFINITY, -0.99996, 7, 8, 9, -6e-5},
                        effort[] = {0.25, -0.5}, force[] = {1, 2, 3, 4, 5, 6, 7, 8.5}, t[] = {0, 0.5},
                        lengths[] = {0.1, 0.2}, x[] = {5e-4, 2.0006}, y[] = {-6e-4, 3}, depth[] = {-1, 4.25};
    const moray_scene_body bodies[] = {{.name = "a<b\"\n",
                                        .colour = MORAY_COLOUR_BASELINE,
                                        .links = 2,
                                        .length = 0.15,
                                        .width = 0.05,
                                        .lengths = lengths,
                                        .at = at,
                                        .effort = effort,
                                        .force = force},
                                       {.name = "second", .links = 1, .length = 1, .width = 0.5, .at = at + 3}};
    const moray_channel channels[] = {{"depth", "m", depth}, {"time", NULL, t}};
    const moray_scene scene = {.title = "T",
                               .frames = 2,
                               .t = t,
                               .bodies = bodies,
                               .n_bodies = 2,
                               .current = {-0.1, 0.25},
                               .asked_x = x,
                               .asked_y = y,
                               .n_asked = 2,
                               .channels = channels,
                               .n_channels = 2};
    char *data = data_of(&scene);
    static const char wanted[] =
        "{\"title\":\"T\",\"current\":[-0.1000,0.2500],\"t\":[0,0.5000],\"asked\":[[0,-0.001],[2.001,3.000]],"
        "\"channels\":[{\"name\":\"depth\",\"unit\":\"m\",\"values\":[-1.0000,4.2500]},"
        "{\"name\":\"time\",\"unit\":\"\",\"values\":[0,0.5000]}],"
        "\"bodies\":[{\"name\":\"a\\u003cb\\u0022\\u000a\",\"colour\":1,\"length\":0.1500,\"width\":0.0500,"
        "\"lengths\":[0.1000,0.2000],"
        "\"at\":[[0,0,0.0001,1.2346,-2.0000,0],\n[0,-1.0000,7.0000,8.0000,9.0000,-0.0001]],"
        "\"effort\":[[0.2500],\n[-0.5000]],"
        "\"force\":[[1.0000,2.0000,3.0000,4.0000],\n[5.0000,6.0000,7.0000,8.5000]]}\n"
        ",{\"name\":\"second\",\"colour\":1,\"length\":1.0000,\"width\":0.5000,"
        "\"at\":[[1.2346,-2.0000,0],\n[0,-1.0000,7.0000]]}\n"
        "]}\n</script>\n";
    CHECK(strcmp(data, wanted) == 0, "%s", data);
    free(data);
}

// Folders that were made on the way go again, those that were there stay.
static void test_folders(void)
{
    CHECK(mkdir(in_root("there"), 0777) == 0, "a folder");
    moray_output *output = open_in("there/made/deeper/down");
    CHECK(entries("there") == 0, "nothing is there before there is a file");
    fputs("x", start(output, "a.txt"));
    CHECK(entries("there/made/deeper/down") == 1, "then there is the place of it");
    moray_output_free(output);
    CHECK(entries("there") == 0, "without an end all that was made goes");
    output = open_in("there/made//deeper/");
    fputs("x", start(output, "a.txt"));
    CHECK_OK(moray_output_commit(output), "an end");
    moray_output_free(output);
    CHECK(entries("there/made/deeper") == 1 && holds("there/made/deeper/a.txt", "x"), "with one it stays");
}

int main(void)
{
    if (!enter())
        return 1;
    test_numbers();
    test_folders();
    leave();
    return tap_done();
}
