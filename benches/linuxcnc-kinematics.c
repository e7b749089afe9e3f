/* Joints of LinuxCNC's tilting-table machines, computed by LinuxCNC's own kinematics module outside of its realtime part.
 *
 *   cc -o kinematics linuxcnc-kinematics.c -ldl -lm && ./kinematics xyzac-trt-kins.so < places
 *
 * Reads lines of X Y Z A B C (mm, degrees, on the part) and writes the five joints for each (mm, degrees). The module finds its
 * HAL functions here: pins are numbers that are 0, so both axes meet at the machine's zero. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

/* What the module calls; signatures as in hal.h and rtapi.h. */
int hal_init(const char *name) { (void)name; return 1; }
int hal_exit(int id) { (void)id; return 0; }
int hal_ready(int id) { (void)id; return 0; }
void *hal_malloc(long size) { return calloc(1, (size_t)size); }
static int pin(void **data) { *data = calloc(1, sizeof(double)); return 0; }
int hal_pin_float_newf(int direction, void **data, int id, const char *format, ...) { (void)direction; (void)id; (void)format; return pin(data); }
int hal_pin_bit_new(const char *name, int direction, void **data, int id) { (void)name; (void)direction; (void)id; return pin(data); }
int hal_pin_s32_new(const char *name, int direction, void **data, int id) { (void)name; (void)direction; (void)id; return pin(data); }
void rtapi_print(const char *format, ...) { (void)format; }
void rtapi_print_msg(int level, const char *format, ...) { (void)level; (void)format; }

int main(int count, char **arguments) {
    void *module = count > 1 ? dlopen(arguments[1], RTLD_NOW) : NULL;
    if (!module) {
        fprintf(stderr, "usage: kinematics MODULE.so < places; %s\n", dlerror());
        return 2;
    }
    int (*begin)(void) = (int (*)(void))dlsym(module, "rtapi_app_main");
    int (*inverse)(const double *, double *, const unsigned long *, unsigned long *) =
        (int (*)(const double *, double *, const unsigned long *, unsigned long *))dlsym(module, "kinematicsInverse");
    if (!begin || !inverse || begin() != 0) {
        fprintf(stderr, "%s is no kinematics module\n", arguments[1]);
        return 2;
    }
    /* x y z, then a b c, then u v w. */
    double place[9] = {0}, joints[16] = {0};
    while (scanf("%lf %lf %lf %lf %lf %lf", &place[0], &place[1], &place[2], &place[3], &place[4], &place[5]) == 6) {
        unsigned long flags = 0, forward = 0;
        if (inverse(place, joints, &flags, &forward) != 0) {
            fprintf(stderr, "no joints for %f %f %f\n", place[0], place[1], place[2]);
            return 1;
        }
        printf("%.9f %.9f %.9f %.9f %.9f\n", joints[0], joints[1], joints[2], joints[3], joints[4]);
    }
    return 0;
}
