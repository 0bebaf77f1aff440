// SPDX-License-Identifier: MIT
//
// The robot for other simulators. Both formats know a mass that is the same in every direction: of the water's inertia
// they take what turns with a link, and the rest is told in a comment.
#include "export.h"

#include <math.h>

// Of one link, about its centre: along, across, upright; the last with the water's [kg m^2].
typedef struct inertia {
    double xx, yy, zz;
} inertia;

static moray_link link_of(const export_job *job, int number)
{
    return moray_robot_link(&job->snake.robot, number - 1);
}

// Added inertia of a link that turns about its centre of mass: lambda_1 of (4), or of strips, or of pieces, what acts
// at the centre of buoyancy, and its fin.
static double added(const moray_hydrodynamics *hydro, const moray_link *link)
{
    const double half = link->l - fabs(link->cb), strip = link->mu_n * half * half / 3, k = fmax(hydro->pieces, 1);
    const double lever = link->cb - link->cm, fin = link->fin_at - link->cm;
    const double beside = link->mu_n * lever * lever + link->fin_mu_n * fin * fin;
    if (hydro->rotation == MORAY_ROTATION_STRIP)
        return strip + beside;
    return link->lambda_1 / (k * k) + (1 - 1 / (k * k)) * strip + beside;
}

// The upright moment is the robot's, the others those of the solid elliptic cylinder of its mass.
static inertia inertia_of(const export_job *job, const moray_link *link)
{
    const double a = job->snake.geometry.a_e, b = job->snake.geometry.b_e, m = link->m;
    return (inertia){m * (a * a + b * b) / 4, m * (link->l * link->l / 3 + b * b / 4),
                     link->J + added(&job->snake.robot.hydro, link)};
}

// ---- What the formats cannot say -----------------------------------------------------------------------------------

static void put_comment(FILE *file, const export_job *job, const char *format)
{
    const moray_robot *r = &job->snake.robot;
    const moray_link of = link_of(job, 1);
    fprintf(
        file,
        "<!-- moray %s. %d links of %.10g kg, %.10g m long, in the plane z = 0; joint i from the tail is at phi_i = "
        "theta_i - theta_(i+1) [rad].\n"
        "     The moment of inertia about z is that of the link, %.10g kg m^2, and of the water that turns with it, "
        "%.10g kg m^2.\n"
        "     %s cannot say what acts along and across a link differently; a plugin has to add to each link, with v "
        "its velocity relative\n"
        "     to the water and t, n along and across it: - c_t v_t t - c_n v_n n (c_t = %.10g, c_n = %.10g kg/s), - "
        "mu_n "
        "dv_n/dt n (mu_n = %.10g kg)\n"
        "     and the torque - lambda_2 w - lambda_3 |w| w (%.10g kg m^2/s, %.10g kg m^2).%s -->\n",
        moray_version(), r->links, r->m, 2 * r->l, r->J, added(&r->hydro, &of), format, r->c_t, r->c_n, r->mu_n,
        r->lambda_2, r->lambda_3,
        r->link ? "\n     The links differ: these are the means (but for the water that turns with link 1); each has "
                  "its own in the "
                  "robot's INI file."
        : r->hydro.drag == MORAY_DRAG_LINEAR && r->hydro.rotation == MORAY_ROTATION_PAPER && r->hydro.pieces < 2
            ? ""
            : "\n     This robot's hydrodynamics have other terms than these: see src/snake/README.md of moray.");
}

// ---- URDF ----------------------------------------------------------------------------------------------------------

// Frames stand at the tail end of their links.
static void put_urdf_link(FILE *file, const export_job *job, int link)
{
    const moray_link of = link_of(job, link);
    const inertia about = inertia_of(job, &of);
    const moray_link_geometry *shape = &job->snake.geometry;
    const double l = of.l;
    fprintf(
        file,
        "  <link name=\"link_%d\">\n    <inertial>\n      <origin xyz=\"%.17g 0 0\"/>\n      <mass value=\"%.17g\"/>\n"
        "      <inertia ixx=\"%.17g\" ixy=\"0\" ixz=\"0\" iyy=\"%.17g\" iyz=\"0\" izz=\"%.17g\"/>\n    </inertial>\n"
        "    <visual>\n      <origin xyz=\"%.17g 0 0\"/>\n      <geometry><box size=\"%.17g %.17g "
        "%.17g\"/></geometry>\n"
        "    </visual>\n  </link>\n",
        link, l + of.cm, of.m, about.xx, about.yy, about.zz, l, 2 * l, 2 * shape->a_e, 2 * shape->b_e);
}

// Between links i and i + 1; its axis points down, so that its angle is phi_i.
static void put_urdf_joint(FILE *file, const export_job *job, int joint)
{
    fprintf(file,
            "  <joint name=\"joint_%d\" type=\"continuous\">\n    <parent link=\"link_%d\"/>\n    <child "
            "link=\"link_%d\"/>\n    <origin xyz=\"%.17g 0 0\"/>\n    <axis xyz=\"0 0 -1\"/>\n  </joint>\n",
            joint, joint, joint + 1, 2 * link_of(job, joint).l);
}

static void put_urdf(FILE *file, const export_job *job)
{
    const int N = job->snake.robot.links;
    fputs("<?xml version=\"1.0\"?>\n", file);
    put_comment(file, job, "URDF");
    fprintf(file, "<robot name=\"%s\">\n", job->name);
    for (int i = 1; i <= N; i++)
        put_urdf_link(file, job, i);
    for (int i = 1; i < N; i++)
        put_urdf_joint(file, job, i);
    fputs("</robot>\n", file);
}

// ---- MuJoCo --------------------------------------------------------------------------------------------------------

// Link 1 moves freely in the plane, the others turn about their tail ends.
static void open_body(FILE *file, const export_job *job, int link)
{
    static const char *const plane =
        "<joint name=\"x\" type=\"slide\" axis=\"1 0 0\"/><joint name=\"y\" type=\"slide\" axis=\"0 1 0\"/>"
        "<joint name=\"heading_1\" type=\"hinge\" axis=\"0 0 1\"/>";
    const moray_link of = link_of(job, link);
    const inertia about = inertia_of(job, &of);
    const double l = of.l;
    const moray_link_geometry *shape = &job->snake.geometry;
    fprintf(file, "    <body name=\"link_%d\" pos=\"%.17g 0 0\">", link, link > 1 ? 2 * link_of(job, link - 1).l : 0);
    if (link > 1)
        fprintf(file, "<joint name=\"joint_%d\" type=\"hinge\" axis=\"0 0 -1\"/>\n", link - 1);
    else
        fprintf(file, "%s\n", plane);
    fprintf(file,
            "    <inertial pos=\"%.17g 0 0\" mass=\"%.17g\" diaginertia=\"%.17g %.17g %.17g\"/>\n"
            "    <geom type=\"box\" pos=\"%.17g 0 0\" size=\"%.17g %.17g %.17g\" contype=\"0\" conaffinity=\"0\"/>\n",
            l + of.cm, of.m, about.xx, about.yy, about.zz, l, l, shape->a_e, shape->b_e);
}

static void put_numeric(FILE *file, const char *name, double value)
{
    fprintf(file, "    <numeric name=\"%s\" data=\"%.17g\"/>\n", name, value);
}

static void put_mujoco(FILE *file, const export_job *job)
{
    const moray_robot *robot = &job->snake.robot;
    fputs("<?xml version=\"1.0\"?>\n", file);
    put_comment(file, job, "MuJoCo");
    fprintf(file,
            "<mujoco model=\"%s\">\n  <compiler angle=\"radian\"/>\n  <option gravity=\"0 0 0\"/>\n  <worldbody>\n",
            job->name);
    for (int i = 1; i <= robot->links; i++)
        open_body(file, job, i);
    fputs("    ", file);
    for (int i = 1; i <= robot->links; i++)
        fputs("</body>", file);
    fputs("\n  </worldbody>\n  <actuator>\n", file);
    for (int i = 1; i < robot->links; i++)
        fprintf(file, "    <motor name=\"torque_%d\" joint=\"joint_%d\"/>\n", i, i);
    fputs("  </actuator>\n  <custom>\n", file);
    put_numeric(file, "c_t", robot->c_t);
    put_numeric(file, "c_n", robot->c_n);
    put_numeric(file, "mu_n", robot->mu_n);
    put_numeric(file, "lambda_2", robot->lambda_2);
    put_numeric(file, "lambda_3", robot->lambda_3);
    fputs("  </custom>\n</mujoco>\n", file);
}

moray_status export_robot(const export_found *found, moray_output *output)
{
    static const struct {
        const char *ending;
        void (*put)(FILE *file, const export_job *job);
    } formats[] = {{"urdf", put_urdf}, {"xml", put_mujoco}};
    for (int k = 0; k < 2; k++) {
        char name[EXPORT_NAME + 8];
        FILE *file;
        snprintf(name, sizeof name, "%s.%s", found->job->name, formats[k].ending);
        MORAY_TRY(moray_output_file(output, name, &file));
        formats[k].put(file, found->job);
    }
    return moray_ok();
}
